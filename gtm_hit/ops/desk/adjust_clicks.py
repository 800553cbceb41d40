"""The clicks that a desk's adjustment may use, and which of them it does.

Measured points and their clicks from Ground; kept correspondences from Check, never a point to test with;
clicks out of files. One that somebody dropped is left out as long as it is where it was then.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gtm_hit.formats.dataset_folder import natural_key
from gtm_hit.models import Click, ClickDecision, Desk, KeptPoint

GROUND, KEPT = "ground", "kept"  # sources; any other one is a file's digest
FEET = "feet"


@dataclass(frozen=True)
class Clicked:
    """One point in one picture."""

    source: str
    point: str
    camera: str
    x: float
    y: float
    part: str = ""  # feet or head, where a file says so
    frame: str = ""  # of the dataset, where it is not the picture of the desk

    @property
    def key(self) -> tuple[str, str, str]:
        return self.source, self.point, self.camera


@dataclass(frozen=True)
class Decided:
    """What is said of clicks that are still where they were when it was said."""

    kept: frozenset[tuple[str, str, str]]
    dropped: frozenset[tuple[str, str, str]]


def all_clicks(desk: Desk) -> list[Clicked]:
    """Also those that were dropped; point by point, always in the same order."""
    names = set(desk.cameras.values_list("name", flat=True))
    found = [*_of_ground(desk), *_of_kept(desk), *_of_files(desk)]
    return [each for each in found if each.camera in names]


def used(desk: Desk) -> list[Clicked]:
    """Those that nobody dropped."""
    clicks = all_clicks(desk)
    dropped = decided(desk, clicks).dropped
    return [each for each in clicks if each.key not in dropped]


def decided(desk: Desk, clicks: list[Clicked]) -> Decided:
    said = {
        (row.source, row.point, row.camera, row.x, row.y): row.decision for row in desk.click_decisions.all()
    }
    by_decision: dict[str, set[tuple[str, str, str]]] = {each: set() for each in ClickDecision.Decision}
    for click in clicks:
        decision = said.get((*click.key, click.x, click.y))
        if decision:
            by_decision[decision].add(click.key)
    return Decided(
        frozenset(by_decision[ClickDecision.Decision.KEEP]),
        frozenset(by_decision[ClickDecision.Decision.DROP]),
    )


def _of_ground(desk: Desk) -> Iterator[Clicked]:
    rows = Click.objects.filter(camera__desk=desk).select_related("camera", "point")
    for row in rows.order_by("point__number", "camera__index"):
        yield Clicked(GROUND, row.point.name, row.camera.name, row.x, row.y)


def _of_kept(desk: Desk) -> Iterator[Clicked]:
    rows = desk.kept_points.filter(use=KeptPoint.Use.CORRESPONDENCE).prefetch_related("clicks__camera")
    for point in sorted(rows, key=lambda row: natural_key(row.name)):
        for click in sorted(point.clicks.all(), key=lambda each: each.camera.index):
            yield Clicked(KEPT, point.name, click.camera.name, click.x, click.y)


def _of_files(desk: Desk) -> Iterator[Clicked]:
    order = list(desk.cameras.order_by("index").values_list("name", flat=True))
    for file in desk.click_files.filter(used=True).order_by("digest"):
        for point in file.points:
            for camera in order:
                if camera in point["clicks"]:
                    x, y = point["clicks"][camera]
                    part, frame = point["part"], point["frame"]
                    yield Clicked(file.digest, point["name"], camera, x, y, part, frame)
