"""Cameras on a map: a dot, the direction it looks in, and its name where there is room."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from gtm_hit.geometry.camera import Camera, back_project
from gtm_hit.metrics.figures import svg

# Fixed colours: a mark is readable on every shade of the map and outside it.
DARK, LIGHT = "#10151c", "#ffffff"
WEDGE, OPENING = 17.0, math.radians(25)  # pixels, half angle
NAME_HEIGHT = 15.0

Box = tuple[float, float, float, float]  # left, top, right, bottom in pixels


@dataclass(frozen=True)
class CameraMark:
    name: str
    x: float  # metres
    y: float
    towards: tuple[float, float] | None = None  # a point on the ground it looks at, metres


def camera_mark(camera: Camera) -> CameraMark:
    """Where a camera stands; it looks at what the middle of its image's lower edge shows."""
    x, y, _ = camera.centre.tolist()
    to_x, to_y = back_project(camera, [[camera.width / 2, camera.height - 1.0]])[0].tolist()
    return CameraMark(camera.name, x, y, None if math.isnan(to_x) else (to_x, to_y))


def camera_marks(
    marks: Sequence[CameraMark], pixels: Callable[[float, float], tuple[float, float]], limits: Box
) -> list[str]:
    """Wedges first, then dots, then names: cameras may hang on one pole, and no name may be hidden."""
    wedges, dots, names = [], [], []
    taken = [_around(pixels(mark.x, mark.y), 5.0, 5.0) for mark in marks]
    for mark in marks:
        x, y = pixels(mark.x, mark.y)
        angle = None
        if mark.towards is not None:
            to_x, to_y = pixels(*mark.towards)
            angle = math.atan2(to_y - y, to_x - x)
            wedges.append(_wedge(x, y, angle))
        dots.append(svg.element("circle", cx=x, cy=y, r=3.5, fill=DARK, stroke=LIGHT))
        box = _free_box((x, y), mark.name, angle, taken, limits)
        taken.append(box)
        names.append(_name(box, mark.name))
    return [*wedges, *dots, *names]


def _wedge(x: float, y: float, angle: float) -> str:
    ends = [(x + WEDGE * math.cos(a), y + WEDGE * math.sin(a)) for a in (angle - OPENING, angle + OPENING)]
    points = " ".join(f"{svg.number(a)},{svg.number(b)}" for a, b in [(x, y), *ends])
    return svg.element("polygon", points=points, fill=DARK, stroke=LIGHT, stroke_linejoin="round")


def _free_box(
    place: tuple[float, float], name: str, angle: float | None, taken: list[Box], limits: Box
) -> Box:
    """The first place for a name that hides nothing, beginning behind the camera and going round it."""
    behind = math.pi / 2 if angle is None else angle + math.pi
    half_width, half_height = svg.text_width(name, svg.SMALL) / 2 + 4, NAME_HEIGHT / 2
    boxes = []
    for distance in (6.0, 20.0, 36.0):
        for turn in (0, 1, -1, 2, -2, 3, -3):
            towards = behind + turn * math.pi / 5
            x = place[0] + math.cos(towards) * (half_width + distance)
            y = place[1] + math.sin(towards) * (half_height + distance)
            boxes.append(_around((x, y), half_width, half_height))
    free = (box for box in boxes if _within(box, limits) and not any(_touch(box, other) for other in taken))
    return next(free, boxes[0])


def _name(box: Box, words: str) -> str:
    left, top, right, bottom = box
    plate = svg.element(
        "rect", x=left, y=top, width=right - left, height=bottom - top, rx=3, fill=LIGHT, stroke=DARK
    )
    middle = (left + right) / 2
    return plate + svg.text(
        middle, bottom - 4, words, text_anchor="middle", font_size=svg.SMALL, font_weight="bold", fill=DARK
    )


def _around(place: tuple[float, float], half_width: float, half_height: float) -> Box:
    x, y = place
    return x - half_width, y - half_height, x + half_width, y + half_height


def _within(box: Box, limits: Box) -> bool:
    return box[0] >= limits[0] and box[1] >= limits[1] and box[2] <= limits[2] and box[3] <= limits[3]


def _touch(one: Box, other: Box) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]
