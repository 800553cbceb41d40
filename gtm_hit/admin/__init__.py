"""The back door: what workers and programs wrote is looked at here and changed by the operations only."""

from __future__ import annotations

from django.contrib import admin

from gtm_hit.admin import (
    access,
    campaigns,
    datasets,
    desks,
    drift,
    jobs,
    layers,
    money,
    proposals,
    quality,
    review,
    stitching,
    sync,
    work,
)

__all__ = [
    "access",
    "campaigns",
    "datasets",
    "desks",
    "drift",
    "jobs",
    "layers",
    "money",
    "proposals",
    "quality",
    "review",
    "stitching",
    "sync",
    "work",
]

admin.site.site_header = admin.site.site_title = "Ground Truth Marker"
