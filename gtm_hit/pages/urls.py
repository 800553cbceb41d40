from __future__ import annotations

from django.urls import URLPattern, URLResolver

from gtm_hit.pages import (
    api_tokens,
    calibration,
    calibration_versions,
    drift,
    gold,
    home,
    hooks,
    jobs,
    pay,
    people,
    platform,
    proposals,
    qualifications,
    releases,
    scores,
    stitching,
    sync,
)
from gtm_hit.pages.campaigns import links as campaign_links
from gtm_hit.pages.campaigns import listing as campaigns
from gtm_hit.pages.campaigns import rules as campaign_rules
from gtm_hit.pages.campaigns import workers as campaign_workers
from gtm_hit.pages.datasets import importing as dataset_imports
from gtm_hit.pages.datasets import listing as datasets
from gtm_hit.pages.desk import adjust as desk_adjust
from gtm_hit.pages.desk import board as desk_board
from gtm_hit.pages.desk import check as desk_check
from gtm_hit.pages.desk import desks
from gtm_hit.pages.desk import ground as desk_ground
from gtm_hit.pages.desk import lens as desk_lens
from gtm_hit.pages.desk import place as desk_place
from gtm_hit.pages.layers import importing as annotation_imports
from gtm_hit.pages.layers import listing as layers
from gtm_hit.pages.quality import comparing, statistics, text_files
from gtm_hit.pages.review import desk, waiting
from gtm_hit.pages.work import batches, decision, invitation, my_work, qualifying, workplace

urlpatterns: list[URLPattern | URLResolver] = [
    *home.urlpatterns,
    *datasets.urlpatterns,
    *batches.urlpatterns,
    *campaign_rules.urlpatterns,  # before a campaign's name: `new` is none
    *campaigns.urlpatterns,
    *campaign_links.urlpatterns,
    *campaign_workers.urlpatterns,
    *layers.urlpatterns,
    *annotation_imports.urlpatterns,
    *stitching.urlpatterns,
    *releases.urlpatterns,
    *proposals.urlpatterns,
    *statistics.urlpatterns,
    *comparing.urlpatterns,
    *text_files.urlpatterns,
    *jobs.urlpatterns,
    *dataset_imports.urlpatterns,
    *sync.urlpatterns,
    *calibration.urlpatterns,
    *calibration_versions.urlpatterns,
    *drift.urlpatterns,
    *desks.urlpatterns,
    *desk_ground.urlpatterns,
    *desk_lens.urlpatterns,
    *desk_board.urlpatterns,
    *desk_adjust.urlpatterns,
    *desk_check.urlpatterns,
    *desk_place.urlpatterns,
    *api_tokens.urlpatterns,
    *people.urlpatterns,
    *hooks.urlpatterns,
    *pay.urlpatterns,
    *platform.urlpatterns,
    *workplace.urlpatterns,
    *my_work.urlpatterns,
    *invitation.urlpatterns,
    *waiting.urlpatterns,
    *desk.urlpatterns,
    *decision.urlpatterns,
    *qualifying.urlpatterns,
    *qualifications.urlpatterns,
    *gold.urlpatterns,
    *scores.urlpatterns,
]
