from __future__ import annotations

from django.urls import URLPattern, URLResolver

from gtm_hit.pages import batches, calibration, compare, datasets, home, imports, jobs, layers, statistics, work

urlpatterns: list[URLPattern | URLResolver] = [
    *home.urlpatterns,
    *datasets.urlpatterns,
    *batches.urlpatterns,
    *layers.urlpatterns,
    *statistics.urlpatterns,
    *compare.urlpatterns,
    *jobs.urlpatterns,
    *imports.urlpatterns,
    *calibration.urlpatterns,
    *work.urlpatterns,
]
