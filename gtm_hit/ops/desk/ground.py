"""What the page Ground shows: measured points, and each camera's clicks, pose and findings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from django.contrib.auth.models import User

from gtm_hit.calibration.ground_files import PointList, parse_points
from gtm_hit.calibration.ground_points import GroundPoint, GroundPointsError, doubts, regular_grid
from gtm_hit.calibration.pair_files import parse_pairs
from gtm_hit.models import Desk, DeskCamera
from gtm_hit.ops.desk import edits, points, poses
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.things import CLICK, POINT, camera_of


def whole(desk: Desk) -> dict[str, Any]:
    """Everything on the page, as JSON values."""
    there = _points(desk)
    return {
        "points": [asdict(point) for point in there],
        "doubts": doubts(there, "m") if there else [],
        "cameras": [camera(each) for each in desk.cameras.all()],
        **asdict(edits.steps(desk, edits.GROUND)),
    }


def one(desk: Desk, name: str) -> dict[str, Any]:
    """What a click changes: its camera, and what can be undone."""
    return {"camera": camera(camera_of(desk, name)), **asdict(edits.steps(desk, edits.GROUND))}


def camera(row: DeskCamera) -> dict[str, Any]:
    placed = poses.from_ground(row)  # with which the points expected go together
    return {
        "name": row.name,
        "width": row.width,
        "height": row.height,
        "light": row.light_digest,
        "full": row.full_digest,
        "lens": row.lens["source"] if row.lens else "",
        "clicks": {each.point.name: [each.x, each.y] for each in row.clicks.select_related("point")},
        "placed": placed.as_json() if placed else None,
        "report": row.pose_report or {"problem": poses.NO_LENS if row.lens is None else ""},
    }


def put_file(desk: Desk, data: bytes, name: str, unit: str = "", user: User | None = None) -> PointList:
    """The points of a CSV or JSON file. Raises FormatError, DeskError."""
    found = parse_points(data, name, unit)
    points.put_all(desk, found.points, f"points of {name}", user)
    return found


def put_grid(
    desk: Desk,
    columns: int,
    rows: int,
    spacing: tuple[float, float],
    origin: tuple[float, float] = (0.0, 0.0),
    user: User | None = None,
) -> None:
    """A regular grid on the ground, metres. Raises DeskError."""
    try:
        made = regular_grid(columns, rows, spacing, origin)
    except GroundPointsError as error:
        raise DeskError(f"This is {error}.") from error
    points.put_all(desk, made, f"grid of {columns} × {rows} points", user)


def put_pairs(desk: Desk, name: str, data: bytes, file: str, unit: str = "", user: User | None = None) -> int:
    """Clicks of one camera out of a JSON file, and the points it holds that the desk lacks; how many clicks.

    Raises FormatError, DeskError.
    """
    row = camera_of(desk, name)
    there = _points(desk)
    known = PointList(tuple(there), "m", ()) if there else None
    found = parse_pairs(data, file, known, unit)
    if found.camera not in {"", name}:
        raise DeskError(f"{file} is of camera {found.camera}, not {name}.")
    _refuse_other_places(there, [GroundPoint(pair.name, *pair.point) for pair in found.pairs])
    outside = [
        pair.name
        for pair in found.pairs
        if row.width and not (-0.5 <= pair.pixel[0] < row.width and -0.5 <= pair.pixel[1] < row.height)
    ]
    if outside:
        raise DeskError(f"Outside the picture of {name}: {', '.join(outside[:20])}.")
    names = {point.name for point in there}
    last = desk.points.order_by("-number").first()
    start = last.number if last else 0
    new = [pair for pair in found.pairs if pair.name not in names]
    wanted: list[edits.Wanted] = [
        (POINT, [pair.name], [start + number, *map(float, pair.point)])
        for number, pair in enumerate(new, start=1)
    ]
    wanted += [(CLICK, [name, pair.name], list(map(float, pair.pixel))) for pair in found.pairs]
    edits.edit(desk, edits.GROUND, f"clicks of {file} in {name}", wanted, user)
    return len(found.pairs)


def _points(desk: Desk) -> list[GroundPoint]:
    return [GroundPoint(each.name, each.x, each.y, each.z) for each in desk.points.order_by("number")]


def _refuse_other_places(there: Sequence[GroundPoint], given: Sequence[GroundPoint]) -> None:
    places = {point.name: point.place for point in there}
    for point in given:
        place = places.get(point.name, point.place)
        if any(abs(one - other) > 1e-6 for one, other in zip(place, point.place, strict=True)):
            raise DeskError(f"The point {point.name} has other coordinates in the file than on the desk.")
