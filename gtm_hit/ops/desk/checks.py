"""What the page Check shows: cameras, kept points and how far they are off, and a verdict in words.

Under the desk's own cameras, or under those of its dataset that are in place.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from gtm_hit.calibration.kept_points import PointFigures, Summary, point_figures, summary
from gtm_hit.geometry.camera import Camera, CameraModel
from gtm_hit.models import Desk, DeskCamera, KeptPoint
from gtm_hit.ops.desk import edits, kept, overview, poses
from gtm_hit.ops.desk.overview import SHARP_WIDTH, Page, Step, Verdict

ENOUGH = 5  # test points, for a good verdict


class Against(StrEnum):
    """Which calibration is checked."""

    DESK = "desk"
    IN_PLACE = "in-place"


@dataclass(frozen=True)
class Lack:
    """The step a camera needs before it can take part."""

    page: Page
    words: str


def cameras_of(desk: Desk, against: Against = Against.DESK) -> dict[str, Camera]:
    """Those that are calibrated, by name, in the desk's order."""
    if against is Against.DESK:
        found = [poses.calibrated(row) for row in desk.cameras.all()]
    else:
        found = list(_in_place(desk).values())
    return {camera.name: camera for camera in found if camera is not None}


def figures(row: KeptPoint, cameras: Mapping[str, Camera]) -> PointFigures:
    return point_figures(kept.clicks_of(row), cameras)


def shown(desk: Desk) -> dict[str, Any]:
    """What the page needs, as JSON values; it computes the figures itself."""
    in_place = _in_place(desk)
    return {
        "cameras": [_camera(row, in_place.get(row.name)) for row in desk.cameras.all()],
        **points(desk),
    }


def points(desk: Desk) -> dict[str, Any]:
    """Kept points without figures, which take a second for hundreds of them."""
    plain = [_plain(row) for row in kept.all_kept(desk)]
    return {"kept": plain, **asdict(edits.steps(desk, kept.PAGE))}


def whole(desk: Desk, against: Against = Against.DESK) -> dict[str, Any]:
    """Kept points with their figures, and those of all together."""
    cameras = cameras_of(desk, against)
    told = [(row, figures(row, cameras)) for row in kept.all_kept(desk)]
    return {
        "against": against.value,
        "cameras": [_without_numbers(_camera(row, None), cameras) for row in desk.cameras.all()],
        "kept": [_told(row, found) for row, found in told],
        "summaries": {
            use: asdict(summary(found for row, found in told if row.use == use)) for use in kept.Use.values
        },
        **asdict(edits.steps(desk, kept.PAGE)),
    }


def one(desk: Desk, row: KeptPoint | None, was: str) -> dict[str, Any]:
    """What a change leaves: the point, which was called `was`, and what can be undone."""
    told = None if row is None else _told(row, figures(row, cameras_of(desk)))
    return {"was": was, "point": told, **asdict(edits.steps(desk, kept.PAGE))}


def step(desk: Desk) -> Step:
    """The verdict of the test points, for the overview."""
    rows = [row for row in kept.all_kept(desk) if row.use == kept.Use.TEST]
    cameras = cameras_of(desk)
    found = summary(figures(row, cameras) for row in rows)
    if found.median is None:
        problem = "No point checked yet." if not rows else "No test point is seen by two placed cameras."
        return Step(Verdict.MISSING, problem)
    return _judged(found, cameras)


def _judged(found: Summary, cameras: Mapping[str, Camera]) -> Step:
    points = "1 test point" if found.points == 1 else f"{found.points} test points"
    told = f"{points}: median {found.median:.1f} px, 95 % within {found.p95:.1f} px."
    widths = [cameras[name].width for name in found.by_camera]
    sharp = float(np.median(widths)) / SHARP_WIDTH
    median = found.median or 0.0
    if median > 3 * sharp:
        return Step(Verdict.DO_NOT_USE, told)
    unseen = [name for name in cameras if name not in found.by_camera]
    if found.points < ENOUGH:
        return Step(Verdict.USABLE, f"{told} {ENOUGH} or more tell more.")
    if unseen:
        return Step(Verdict.USABLE, f"{told} None is clicked in {', '.join(unseen)}.")
    return Step(Verdict.GOOD if median <= sharp else Verdict.USABLE, told)


def lack(row: DeskCamera) -> Lack | None:
    """What keeps a camera out; None where it takes part."""
    if row.lens is None:
        return Lack(Page.LENS, "It has no lens yet.")
    if row.pose is None:
        return Lack(Page.GROUND, overview.ground_step(row).words)
    if not row.full_digest:
        return Lack(Page.GROUND, "It has no picture yet.")
    return None


def _camera(row: DeskCamera, in_place: Camera | None) -> dict[str, Any]:
    placed, lacks = poses.calibrated(row), lack(row)
    return {
        "name": row.name,
        "width": row.width,
        "height": row.height,
        "light": row.light_digest,
        "full": row.full_digest,
        "placed": placed.as_json() if placed else None,
        "in_place": in_place.as_json() if in_place else None,
        "lacks": {"page": lacks.page.value, "words": lacks.words} if lacks else None,
    }


def _without_numbers(camera: dict[str, Any], cameras: Mapping[str, Camera]) -> dict[str, Any]:
    """`placed` says whether it takes part; its numbers are in cameras.json."""
    told = {name: camera[name] for name in ("name", "width", "height", "lacks")}
    return {**told, "placed": camera["name"] in cameras}


def _in_place(desk: Desk) -> dict[str, Camera]:
    """The dataset's own, of the model that the browser knows."""
    if desk.dataset is None:
        return {}
    rows = desk.dataset.cameras.filter(model=CameraModel.PINHOLE.value)
    return {row.name: row.calibrated for row in rows}


def _plain(row: KeptPoint) -> dict[str, Any]:
    clicks = [asdict(each) for each in kept.clicks_of(row)]
    return {"name": row.name, "use": row.use, "clicks": clicks}


def _told(row: KeptPoint, found: PointFigures) -> dict[str, Any]:
    spot = found.spot
    clicks = [
        {**asdict(each.seen), "residual": each.residual, "doubtful": each.doubtful} for each in found.clicks
    ]
    return {
        "name": row.name,
        "use": row.use,
        "clicks": clicks,
        "reason": found.reason,
        "place": spot.point.tolist() if spot else None,
        "sigmas": spot.sigmas.tolist() if spot else None,
        "ground_sigma": spot.ground_sigma if spot else None,
        "angle": spot.angle if spot else None,
    }
