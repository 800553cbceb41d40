from __future__ import annotations

from django.urls import URLPattern, URLResolver

from gtm_hit.pages import (
    annotation_import,
    batches,
    calibration,
    compare,
    datasets,
    home,
    imports,
    jobs,
    layers,
    releases,
    statistics,
    text_files,
    tokens,
    work,
)

urlpatterns: list[URLPattern | URLResolver] = [
    *home.urlpatterns,
    *datasets.urlpatterns,
    *batches.urlpatterns,
    *layers.urlpatterns,
    *annotation_import.urlpatterns,
    *releases.urlpatterns,
    *statistics.urlpatterns,
    *compare.urlpatterns,
    *text_files.urlpatterns,
    *jobs.urlpatterns,
    *imports.urlpatterns,
    *calibration.urlpatterns,
    *tokens.urlpatterns,
    *work.urlpatterns,
]
