from __future__ import annotations

from django.urls import URLPattern, URLResolver

from gtm_hit.pages import batches, datasets, home, jobs, layers, work

urlpatterns: list[URLPattern | URLResolver] = [
    *home.urlpatterns,
    *datasets.urlpatterns,
    *batches.urlpatterns,
    *layers.urlpatterns,
    *jobs.urlpatterns,
    *work.urlpatterns,
]
