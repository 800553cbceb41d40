"""What came out of adjusting: used, not used any more, and what has changed since."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

from django.contrib.auth.models import User

from gtm_hit.models import Desk, DeskAdjustment, DeskCamera
from gtm_hit.ops.desk import adjust_inputs, edits, poses
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.ops.desk.things import ADJUSTED

PAGE = "adjust"  # of the edits
NAMED = 6  # points in a sentence


@dataclass(frozen=True)
class InUse:
    """Which result the desk's cameras stand by."""

    number: int | None  # None: by none
    ended: tuple[str, ...]  # cameras whose lens or clicks have changed since: they stand by themselves


def result_of(desk: Desk, number: int | None = None) -> DeskAdjustment:
    """The newest finished one, without a number. Raises NotThere."""
    finished = desk.adjustments.filter(report__isnull=False)
    found = finished.first() if number is None else finished.filter(number=number).first()
    if found is None:
        raise NotThere(f"The desk has no result {number} of an adjustment." if number else "No result yet.")
    return found


def in_use(desk: Desk) -> InUse:
    return in_use_by(desk.cameras.order_by("index"))


def in_use_by(cameras: Collection[DeskCamera]) -> InUse:
    numbers = {camera.adjusted["number"] for camera in cameras if camera.adjusted is not None}
    ended = tuple(camera.name for camera in cameras if camera.adjusted and poses.adjusted_of(camera) is None)
    return InUse(max(numbers, default=None), ended)


def use(desk: Desk, number: int | None = None, user: User | None = None) -> DeskAdjustment:
    """All cameras stand where a result has them, with its lenses; undone in one step. Raises DeskError."""
    found = result_of(desk, number)
    rows = {row.name: row for row in desk.cameras.all()}
    cameras: dict[str, Any] = found.cameras or {}
    if set(rows) != set(cameras):
        raise DeskError(f"The desk has other cameras than result {found.number}: adjust again.")
    changed = [name for name, row in rows.items() if cameras[name]["from"] != poses.beginning(row)]
    if changed:
        raise DeskError(
            f"The lens or the ground points of {', '.join(changed)} have changed since result "
            f"{found.number}: adjust again."
        )
    wanted = [(ADJUSTED, [name], value) for name, value in cameras.items()]
    edits.edit(desk, PAGE, f"result {found.number} used", wanted, user)
    return found


def go_back(desk: Desk, user: User | None = None) -> None:
    """Each camera by its own lens and clicks again. Raises DeskError where no result is used."""
    names = [row.name for row in desk.cameras.all() if row.adjusted]
    if not names:
        raise DeskError("No result is used.")
    edits.edit(desk, PAGE, "no result used", [(ADJUSTED, [name], None) for name in names], user)


def changes(desk: Desk, found: DeskAdjustment) -> list[str]:
    """Sentences on what has changed since a result; none: the same would come out again."""
    was, now = found.inputs, adjust_inputs.snapshot(desk)
    if was == now:
        return []
    before, after = _by_click(was["clicks"]), _by_click(now["clicks"])
    added, gone = _points(after) - _points(before), _points(before) - _points(after)
    both = set(before) & set(after)
    moved = sum(before[key] != after[key] for key in both)
    more = sum(_point(key) not in added for key in set(after) - both)
    fewer = sum(_point(key) not in gone for key in set(before) - both)
    told = [
        _counted(len(added), "point", "added", _named(added)),
        _counted(len(gone), "point", "taken away", _named(gone)),
        _counted(more, "click", "added"),
        _counted(fewer, "click", "taken away or dropped"),
        _counted(moved, "click", "moved"),
    ]
    measured = [name for name, place in now["measured"].items() if was["measured"].get(name, place) != place]
    if measured:
        told.append(f"Other coordinates now: {', '.join(measured[:NAMED])}.")
    cameras = [name for name, value in now["cameras"].items() if was["cameras"].get(name) != value]
    cameras += [name for name in was["cameras"] if name not in now["cameras"]]
    if cameras:
        told.append(f"Another lens or other ground points now: {', '.join(cameras)}.")
    return [sentence for sentence in told if sentence]


def _by_click(rows: Sequence[Sequence[Any]]) -> dict[tuple[str, str, str], list[float]]:
    return {(source, point, camera): [x, y] for source, point, camera, x, y in rows}


def _point(key: tuple[str, str, str]) -> tuple[str, str]:
    return key[0], key[1]


def _points(clicks: Collection[tuple[str, str, str]]) -> set[tuple[str, str]]:
    return {_point(key) for key in clicks}


def _named(points: set[tuple[str, str]]) -> str:
    names = sorted(name for _source, name in points)
    return ", ".join(names) if 0 < len(names) <= NAMED else ""


def _counted(count: int, noun: str, what: str, names: str = "") -> str:
    if not count:
        return ""
    was = f"1 {noun} was" if count == 1 else f"{count} {noun}s were"
    return f"{was} {what} since{f': {names}' if names else ''}."
