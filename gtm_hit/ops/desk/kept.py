"""Points that several cameras see and nobody measured, kept with their clicks.

Each change is one edit of the page Check. A point whose use is to test is given to no solve, ever.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from django.contrib.auth.models import User
from django.db import transaction

from gtm_hit.calibration.kept_points import SeenAt as SeenAt
from gtm_hit.formats.calibration.clicks import ThingClick, parse_clicks, write_clicks
from gtm_hit.formats.dataset_folder import natural_key
from gtm_hit.models import Desk, DeskCamera, KeptPoint
from gtm_hit.ops.desk import edits
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.ops.desk.things import KEPT_CLICK, KEPT_POINT, camera_of

PAGE = "check"  # of the edits
MOST_POINTS = 5000
NAME_LENGTH = 80
FEWEST = 2  # clicks: one alone has no place

Use = KeptPoint.Use
WORDS = {Use.CORRESPONDENCE: "correspondence", Use.TEST: "test point"}


@dataclass(frozen=True)
class NewPoint:
    name: str
    use: Use
    clicks: tuple[SeenAt, ...]


def kept_of(desk: Desk, name: str) -> KeptPoint:
    """Raises NotThere."""
    found = desk.kept_points.filter(name=name).first()
    if found is None:
        raise NotThere(f"The desk has no kept point {name}.")
    return found


def clicks_of(point: KeptPoint) -> list[SeenAt]:
    """In the order of the cameras. For callers that prefetched, no query."""
    rows = sorted(point.clicks.all(), key=lambda each: each.camera.index)
    return [SeenAt(each.camera.name, each.x, each.y) for each in rows]


def all_kept(desk: Desk) -> list[KeptPoint]:
    """P2 before P10, whatever was undone and done again between; with their clicks."""
    rows = desk.kept_points.prefetch_related("clicks__camera")
    return sorted(rows, key=lambda row: natural_key(row.name))


def keep(
    desk: Desk, clicks: Sequence[SeenAt], use: str, name: str = "", user: User | None = None
) -> KeptPoint:
    """Keep a point under a name, or the next of P1, P2, …. Raises DeskError."""
    wanted = _use(use)
    with transaction.atomic():
        _lock(desk)  # two who keep at once get two names
        name = name or _next_name(desk)
        _put(desk, [NewPoint(name, wanted, tuple(clicks))], f"point {name} kept", user)
        return kept_of(desk, name)


def change(desk: Desk, name: str, other: str = "", use: str = "", user: User | None = None) -> KeptPoint:
    """Another name or use, or both; what is empty stays. Raises DeskError."""
    point = kept_of(desk, name)
    wanted = _use(use) if use else Use(point.use)
    if not other or other == name:
        edits.edit(desk, PAGE, f"{name} is a {WORDS[wanted]}", [(KEPT_POINT, [name], wanted.value)], user)
        return kept_of(desk, name)
    moved = NewPoint(other, wanted, tuple(clicks_of(point)))
    _refuse([moved], _names(desk), _cameras(desk))
    edits.edit(desk, PAGE, f"{name} is called {other}", [*_without(point), *_wanted(moved)], user)
    return kept_of(desk, other)


def put_click(desk: Desk, name: str, seen: SeenAt, user: User | None = None) -> KeptPoint:
    """Where one camera sees it, anew or elsewhere. Raises DeskError."""
    point = kept_of(desk, name)
    _refuse_click(seen, _cameras(desk))
    wanted = [(KEPT_CLICK, [name, seen.camera], [float(seen.x), float(seen.y)])]
    edits.edit(desk, PAGE, f"{name} in {seen.camera}", wanted, user)
    return point


def remove_click(desk: Desk, name: str, camera: str, user: User | None = None) -> KeptPoint:
    """Raises DeskError where too few would be left."""
    point = kept_of(desk, name)
    camera_of(desk, camera)
    others = point.clicks.exclude(camera__name=camera).count()
    if others < FEWEST:
        raise DeskError(f"{name} needs clicks in two views. Remove the point as a whole instead.")
    edits.edit(desk, PAGE, f"{name} in {camera} removed", [(KEPT_CLICK, [name, camera], None)], user)
    return point


def remove(desk: Desk, name: str, user: User | None = None) -> None:
    """With its clicks. Raises NotThere."""
    point = kept_of(desk, name)
    edits.edit(desk, PAGE, f"point {name} removed", _without(point), user)


def put_file(desk: Desk, data: bytes, file: str, use: str, user: User | None = None) -> int:
    """Keep every thing of a file of clicks, CSV or JSON; how many. `use` is of those whose lines say none.

    Raises FormatError, DeskError, and then nothing is kept.
    """
    usual = _use(use)
    things: dict[str, list[ThingClick]] = {}
    for click in parse_clicks(data, file):
        things.setdefault(click.thing, []).append(click)
    made = []
    for thing, clicks in things.items():
        uses = {click.use for click in clicks} - {""}
        if len(uses) > 1:
            raise DeskError(f"{thing} cannot be a test point and a correspondence.")
        seen = tuple(SeenAt(click.camera, click.x, click.y) for click in clicks)
        made.append(NewPoint(thing, Use(uses.pop()) if uses else usual, seen))
    with transaction.atomic():
        _lock(desk)
        _put(desk, made, f"points of {file}", user)
    return len(made)


def as_csv(desk: Desk) -> bytes:
    """All of them, as `put_file` reads them again and `calibrate check` reads them, too."""
    return write_clicks(
        ThingClick(point.name, seen.camera, seen.x, seen.y, point.use)
        for point in all_kept(desk)
        for seen in clicks_of(point)
    )


def _put(desk: Desk, points: Sequence[NewPoint], what: str, user: User | None) -> None:
    names = _names(desk)
    if len(names) + len(points) > MOST_POINTS:
        raise DeskError(f"A desk keeps at most {MOST_POINTS} points.")
    _refuse(points, names, _cameras(desk))
    edits.edit(desk, PAGE, what, [each for point in points for each in _wanted(point)], user)


def _wanted(point: NewPoint) -> list[edits.Wanted]:
    """The point first: a click needs it."""
    clicks = [(KEPT_CLICK, [point.name, one.camera], [float(one.x), float(one.y)]) for one in point.clicks]
    return [(KEPT_POINT, [point.name], point.use.value), *clicks]


def _without(point: KeptPoint) -> list[edits.Wanted]:
    """Clicks first: undoing goes the other way round."""
    clicks = [(KEPT_CLICK, [point.name, each.camera], None) for each in clicks_of(point)]
    return [*clicks, (KEPT_POINT, [point.name], None)]


def _refuse(points: Sequence[NewPoint], names: set[str], cameras: dict[str, DeskCamera]) -> None:
    for point in points:
        _refuse_name(point.name)
        if point.name in names:
            raise DeskError(f"There is a kept point {point.name} already: choose another name.")
        for seen in point.clicks:
            _refuse_click(seen, cameras)
        _refuse_views(point)


def _refuse_views(point: NewPoint) -> None:
    views = [seen.camera for seen in point.clicks]
    twice = next((each for each in views if views.count(each) > 1), None)
    if twice is not None:
        raise DeskError(f"{point.name} is clicked twice in {twice}; a camera sees it in one place.")
    if len(views) < FEWEST:
        raise DeskError(f"{point.name} is clicked in one view only: click it in a second one to keep it.")


def _refuse_name(name: str) -> None:
    # A slash would end an address, a comma or quotation mark a value of a CSV file, # begins a comment there.
    barred = any(sign in name for sign in '/,"') or name.startswith("#") or name != name.strip()
    if not name or len(name) > NAME_LENGTH or not name.isprintable() or barred:
        raise DeskError(
            f"A point's name has 1 to {NAME_LENGTH} signs, none of them a slash, a comma or a quotation mark."
        )


def _refuse_click(seen: SeenAt, cameras: dict[str, DeskCamera]) -> None:
    row = cameras.get(seen.camera)
    if row is None:
        there = ", ".join(cameras) or "none"
        raise DeskError(f"The desk has no camera {seen.camera}; there are: {there}.")
    if not row.width:
        raise DeskError(f"{seen.camera} has no picture yet.")
    if not (math.isfinite(seen.x) and math.isfinite(seen.y)):
        raise DeskError("A click is two finite numbers.")
    if not (-0.5 <= seen.x <= row.width - 0.5 and -0.5 <= seen.y <= row.height - 0.5):
        raise DeskError(
            f"{seen.x:.1f}, {seen.y:.1f} is outside the picture of {row.name}, "
            f"which has {row.width}×{row.height} pixels."
        )


def _use(use: str) -> Use:
    try:
        return Use(use)
    except ValueError as error:
        raise DeskError(
            f"A point is kept as {' or as '.join(Use.values)}, not as {use or 'nothing'}."
        ) from error


def _next_name(desk: Desk) -> str:
    taken = _names(desk)
    number = len(taken) + 1
    while f"P{number}" in taken:
        number += 1
    return f"P{number}"


def _names(desk: Desk) -> set[str]:
    return set(desk.kept_points.values_list("name", flat=True))


def _cameras(desk: Desk) -> dict[str, DeskCamera]:
    return {row.name: row for row in desk.cameras.all()}


def _lock(desk: Desk) -> None:
    Desk.objects.select_for_update().get(pk=desk.pk)
