"""What was made under a version, and each time that it was put in place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from django.contrib.auth.models import User

from gtm_hit.models import Calibration, CalibrationPlacement, Layer, Release, Save
from gtm_hit.ops.calibration.reports import Section, sections


@dataclass(frozen=True)
class Placed:
    """One time that it was put in place."""

    at: datetime
    by: User | None
    source: str
    sections: Sequence[Section]


@dataclass(frozen=True)
class Usage:
    saves: int
    layers: int  # that these saves are of
    releases: Sequence[int]  # their numbers


def usage(version: Calibration) -> Usage:
    made = Save.objects.filter(calibration=version)
    layers = Layer.objects.filter(layer_frames__saves__calibration=version).distinct()
    releases = Release.objects.filter(calibration=version).order_by("number")
    return Usage(made.count(), layers.count(), list(releases.values_list("number", flat=True)))


def placings(version: Calibration) -> list[Placed]:
    """In the order of time; the first one is when the version came to be."""
    again = version.placements.select_related("created_by").order_by("created_at", "pk")
    return [_placed(version), *(_placed(each) for each in again)]


def _placed(row: Calibration | CalibrationPlacement) -> Placed:
    return Placed(row.created_at, row.created_by, row.source, sections(row.report))
