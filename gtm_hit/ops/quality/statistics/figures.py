"""A layer's statistics as figures, SVG each."""

from __future__ import annotations

from collections.abc import Callable

from django.utils.translation import gettext as _

from gtm_hit.metrics.coverage import Coverage
from gtm_hit.metrics.figures import bars, coverage_map, histogram
from gtm_hit.ops.quality.statistics.measuring import LayerStatistics

Draw = Callable[[LayerStatistics, Coverage], str]


def figure(name: str, found: LayerStatistics, ground: Coverage) -> str:
    return FIGURES[name](found, ground)


def _coverage(found: LayerStatistics, ground: Coverage) -> str:
    return coverage_map(ground, found.marks, title=_("Cameras that see each position"))


def _per_view(found: LayerStatistics, ground: Coverage) -> str:
    return bars(
        found.cameras,
        found.visibility.per_view,
        title=_("Annotations visible in each view"),
        x_label=_("view"),
        y_label=_("annotations"),
    )


def _exactly(found: LayerStatistics, ground: Coverage) -> str:
    return bars(
        [str(views) for views in range(len(found.visibility.exactly))],
        found.visibility.exactly,
        title=_("Annotations visible in exactly k views"),
        x_label=_("views k"),
        y_label=_("annotations"),
    )


def _people(found: LayerStatistics, ground: Coverage) -> str:
    return histogram(
        found.people_per_frame,
        title=_("People per frame"),
        x_label=_("people"),
        y_label=_("frames"),
        whole=True,
        decimals=1,
    )


def _track_frames(found: LayerStatistics, ground: Coverage) -> str:
    return histogram(
        found.tracks.annotations,
        title=_("Track lengths"),
        x_label=_("annotated frames"),
        y_label=_("people"),
        whole=True,
        decimals=1,
    )


def _track_metres(found: LayerStatistics, ground: Coverage) -> str:
    return histogram(
        found.tracks.path,
        title=_("Distances walked"),
        x_label=_("metres"),
        y_label=_("people"),
        decimals=1,
    )


def _speeds(found: LayerStatistics, ground: Coverage) -> str:
    return histogram(
        found.speeds,
        title=_("Speeds between neighbouring frames"),
        x_label=_("metres per second"),
        y_label=_("steps"),
        decimals=2,
    )


def _heights(found: LayerStatistics, ground: Coverage) -> str:
    return histogram(
        found.heights,
        title=_("Heights of people"),
        x_label=_("metres"),
        y_label=_("people"),
        decimals=2,
    )


FIGURES: dict[str, Draw] = {
    "coverage": _coverage,
    "visible-per-view": _per_view,
    "visible-in-exactly": _exactly,
    "people-per-frame": _people,
    "track-lengths": _track_frames,
    "distances": _track_metres,
    "speeds": _speeds,
    "heights": _heights,
}
