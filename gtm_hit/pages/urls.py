from __future__ import annotations

from django.urls import URLPattern, URLResolver

from gtm_hit.pages import api_tokens, calibration, home, jobs, proposals, releases
from gtm_hit.pages.datasets import importing as dataset_imports
from gtm_hit.pages.datasets import listing as datasets
from gtm_hit.pages.layers import importing as annotation_imports
from gtm_hit.pages.layers import listing as layers
from gtm_hit.pages.quality import comparing, statistics, text_files
from gtm_hit.pages.work import batches, workplace

urlpatterns: list[URLPattern | URLResolver] = [
    *home.urlpatterns,
    *datasets.urlpatterns,
    *batches.urlpatterns,
    *layers.urlpatterns,
    *annotation_imports.urlpatterns,
    *releases.urlpatterns,
    *proposals.urlpatterns,
    *statistics.urlpatterns,
    *comparing.urlpatterns,
    *text_files.urlpatterns,
    *jobs.urlpatterns,
    *dataset_imports.urlpatterns,
    *calibration.urlpatterns,
    *api_tokens.urlpatterns,
    *workplace.urlpatterns,
]
