"""The measured points of a desk: all of them out of a file or a grid, or one at a time."""

from __future__ import annotations

from collections.abc import Sequence

from django.contrib.auth.models import User

from gtm_hit.calibration.ground_points import GroundPoint
from gtm_hit.models import Click, Desk
from gtm_hit.ops.desk import edits
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.things import CLICK, POINT, point_of

MOST_POINTS = 2000
MOST_METRES = 1e5
NAME_LENGTH = 80


def put_all(desk: Desk, points: Sequence[GroundPoint], what: str, user: User | None = None) -> None:
    """These and no others. Clicks of points that stay by their name stay; those of the others go with them.

    Raises DeskError.
    """
    if len(points) > MOST_POINTS:
        raise DeskError(f"At most {MOST_POINTS} points are sensible, not {len(points)}.")
    for point in points:
        _refuse(point)
    names = [point.name for point in points]
    if len(set(names)) < len(names):
        raise DeskError("A name stands there twice.")
    gone = set(desk.points.values_list("name", flat=True)) - set(names)
    wanted = [*_without(desk, gone)]
    for number, point in enumerate(points, start=1):
        wanted.append((POINT, [point.name], [number, *map(float, point.place)]))
    edits.edit(desk, edits.GROUND, what, wanted, user)


def put(desk: Desk, name: str, x: float, y: float, z: float = 0.0, user: User | None = None) -> None:
    """Add a point, or give one other coordinates, metres. Raises DeskError."""
    point = GroundPoint(name, x, y, z)
    _refuse(point)
    found = desk.points.filter(name=point.name).first()
    last = desk.points.order_by("-number").first()
    if found is None and desk.points.count() >= MOST_POINTS:
        raise DeskError(f"At most {MOST_POINTS} points are sensible.")
    number = found.number if found else (last.number if last else 0) + 1
    wanted = [(POINT, [point.name], [number, *map(float, point.place)])]
    what = f"coordinates of {point.name}" if found else f"point {point.name}"
    edits.edit(desk, edits.GROUND, what, wanted, user)


def remove(desk: Desk, name: str, user: User | None = None) -> None:
    """With its clicks. Raises NotThere."""
    point_of(desk, name)
    edits.edit(desk, edits.GROUND, f"point {name} removed", _without(desk, {name}), user)


def _without(desk: Desk, names: set[str]) -> list[edits.Wanted]:
    """Clicks first: undoing goes the other way round."""
    clicks = Click.objects.filter(camera__desk=desk, point__name__in=names)
    pairs = clicks.order_by("camera__index", "point__number").values_list("camera__name", "point__name")
    return [
        *((CLICK, [camera, point], None) for camera, point in pairs),
        *((POINT, [name], None) for name in sorted(names)),
    ]


def _refuse(point: GroundPoint) -> None:
    if not point.name or len(point.name) > NAME_LENGTH or not point.name.isprintable() or "/" in point.name:
        raise DeskError(f"A point's name has 1 to {NAME_LENGTH} signs, none of them a slash.")
    if not all(abs(value) <= MOST_METRES for value in point.place):  # NaN compares as false, too
        raise DeskError(f"The coordinates of {point.name} are no lengths in metres that can be meant.")
