from __future__ import annotations

from django.apps import AppConfig


class GroundTruthMarkerConfig(AppConfig):
    name = "gtm_hit"
    verbose_name = "Ground Truth Marker"
