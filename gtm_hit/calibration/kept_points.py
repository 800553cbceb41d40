"""How far points clicked in several views are off under a calibration, one by one and all together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from gtm_hit.calibration.checking import CLICK_SIGMA, Click, Spot, spot
from gtm_hit.geometry.camera import Camera

ONE_VIEW = "clicked in fewer than two views that have a calibration"
NOWHERE = "the rays of its clicks meet nowhere the views show"


@dataclass(frozen=True)
class SeenAt:
    camera: str
    x: float  # pixels of the picture as taken
    y: float


@dataclass(frozen=True)
class ClickFigure:
    seen: SeenAt
    residual: float | None  # pixels; None without a place, and in a view without a calibration
    doubtful: bool


@dataclass(frozen=True, eq=False)
class PointFigures:
    clicks: tuple[ClickFigure, ...]
    spot: Spot | None
    reason: str  # why there is no place

    @property
    def residuals(self) -> dict[str, float]:
        """Pixels by camera, of those that have one."""
        return {each.seen.camera: each.residual for each in self.clicks if each.residual is not None}


@dataclass(frozen=True)
class Summary:
    """`points` have a place; `off` of their clicks are beyond 3 σ. Medians and percentiles in pixels."""

    points: int
    clicks: int
    off: int
    median: float | None
    p95: float | None
    by_camera: dict[str, float]  # median


def point_figures(
    clicks: Sequence[SeenAt], cameras: Mapping[str, Camera], sigma: float = CLICK_SIGMA
) -> PointFigures:
    """Cameras without a calibration are in none of `cameras`; their clicks tell nothing."""
    known = [each for each in clicks if each.camera in cameras]
    found = spot([Click(cameras[each.camera], each.x, each.y) for each in known], sigma)
    if found is None:
        reason = ONE_VIEW if len(known) < 2 else NOWHERE
        return PointFigures(tuple(ClickFigure(each, None, False) for each in clicks), None, reason)
    told = dict(zip(known, zip(found.residuals.tolist(), found.doubtful.tolist(), strict=True), strict=True))
    figures = (ClickFigure(each, *told.get(each, (None, False))) for each in clicks)
    return PointFigures(tuple(figures), found, "")


def summary(points: Iterable[PointFigures]) -> Summary:
    placed = [each for each in points if each.spot is not None]
    residuals = [residual for each in placed for residual in each.residuals.values()]
    off = sum(click.doubtful for each in placed for click in each.clicks)
    if not residuals:
        return Summary(len(placed), 0, 0, None, None, {})
    median, p95 = np.percentile(residuals, [50, 95]).tolist()
    return Summary(len(placed), len(residuals), off, median, p95, _by_camera(placed))


def _by_camera(points: Sequence[PointFigures]) -> dict[str, float]:
    found: dict[str, list[float]] = {}
    for each in points:
        for camera, residual in each.residuals.items():
            found.setdefault(camera, []).append(residual)
    return {camera: float(np.median(residuals)) for camera, residuals in found.items()}
