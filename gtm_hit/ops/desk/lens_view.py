"""What the page Lens shows of a camera, ready to be drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gtm_hit.models import BoardPicture, DeskCamera

LONGER = 20  # residuals are drawn this many times as long
NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")


@dataclass(frozen=True)
class Parameter:
    name: str
    value: float
    sigma: float | None  # one standard deviation; None: it was given


@dataclass(frozen=True)
class Bar:
    """One picture: how badly its points fit, or why there is nothing to fit."""

    picture: BoardPicture
    rms: float | None  # pixels; None where it took no part
    share: float  # of the longest bar
    bad: bool  # fits much worse than the others

    @property
    def points(self) -> int:
        return len(self.picture.found["pixels"]) if self.picture.found else 0


@dataclass(frozen=True)
class Cell:
    """A part of the picture and the points that were seen in it."""

    x: float
    y: float
    width: float
    height: float
    count: int
    strength: float  # 0 to 1


@dataclass(frozen=True)
class Arrow:
    x: float
    y: float
    to_x: float
    to_y: float


def parameters(camera: DeskCamera) -> list[Parameter]:
    if camera.lens is None:
        return []
    (fx, _, cx), (_, fy, cy), _ = camera.lens["matrix"]
    sigma = camera.lens_report.get("sigma", {})
    numbers = zip(NAMES, (fx, fy, cx, cy, *camera.lens["distortion"]), strict=False)
    return [Parameter(name, value, sigma.get(name)) for name, value in numbers]


def bars(camera: DeskCamera, pictures: list[BoardPicture]) -> list[Bar]:
    report = camera.lens_report
    rms = {view["name"]: view["rms"] for view in report.get("views", [])}
    longest = max(rms.values(), default=1.0) or 1.0
    bad = report.get("bad_view")
    return [
        Bar(each, rms.get(each.name), rms.get(each.name, 0.0) / longest, each.name == bad)
        for each in pictures
    ]


def cells(camera: DeskCamera) -> list[Cell]:
    counts: list[list[int]] = camera.lens_report.get("coverage", [])
    if not counts:
        return []
    width, height = camera.width / len(counts[0]), camera.height / len(counts)
    most = max(max(row) for row in counts) or 1
    return [
        Cell(column * width, row * height, width, height, count, (count / most) ** 0.5)
        for row, line in enumerate(counts)
        for column, count in enumerate(line)
    ]


def arrows(camera: DeskCamera, picture: BoardPicture) -> list[Arrow]:
    """From each point that was found towards where the lens has it; points alone where it took no part."""
    views: list[dict[str, Any]] = camera.lens_report.get("views", [])
    view = next((each for each in views if each["name"] == picture.name), None)
    if picture.found is None:
        return []
    pixels = picture.found["pixels"]
    missed = view["residuals"] if view else [[0.0, 0.0]] * len(pixels)
    if len(missed) != len(pixels):
        return []
    return [
        Arrow(x, y, x - LONGER * dx, y - LONGER * dy) for (x, y), (dx, dy) in zip(pixels, missed, strict=True)
    ]
