"""Measured points and their clicks in one camera, out of a JSON file.

{"camera": "C1", "unit": "cm", "pairs": [{"name": "A1", "point": [0, 0, 0], "pixel": [518, 400]}, …]}
{"pairs": [{"name": "A1", "pixel": [518, 400]}, …]}                  the points being in a list of their own
{"unit": "cm", "object_points": [[0, 0, 0], …], "image_points": [[518, 400], …]}     named by number: 1, 2, …
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gtm_hit.calibration.ground_files import MOST_BYTES, PointList, Rows, finished, numbers_of
from gtm_hit.calibration.pose_values import Pair
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, shown
from gtm_hit.formats.strict_json import parse_json

Pixel = tuple[float, float]


@dataclass(frozen=True)
class PairList:
    camera: str  # may be empty
    pairs: tuple[Pair, ...]
    doubts: tuple[str, ...]  # what looks wrong about the points


def read_pairs(path: Path, points: PointList | None = None, unit: str = "") -> PairList:
    """Raises FormatError, as `parse_pairs`."""
    return parse_pairs(read_source(path, MOST_BYTES), str(path), points, unit)


def parse_pairs(data: bytes, path: str, points: PointList | None = None, unit: str = "") -> PairList:
    """The pairs of a file; their points are its own, or those of the same names in `points`.

    Raises FormatError with everything that is wrong.
    """
    problems = ProblemList(path)
    content = parse_json(data, path)
    if not isinstance(content, dict):
        problems.add("", f"{shown(content)} is not an object with pairs")
        problems.raise_if_any()
    camera, own = str(content.get("camera", "")), Rows(str(content.get("unit", "")))
    pixels: dict[str, Pixel] = {}
    if "object_points" in content or "image_points" in content:
        _two_lists(content, own, pixels, problems)
    else:
        _one_list(content.get("pairs"), own, pixels, problems)
    problems.raise_if_any()
    if own.values and points is not None:
        problems.add("", "has points of its own; leave out one of the two")
        problems.raise_if_any()
    if not own.values and points is not None:
        return PairList(camera, _named(pixels, points, problems), points.doubts)
    measured = finished(own, unit, problems)
    found = tuple(Pair(point.name, point.place, pixels[point.name]) for point in measured.points)
    return PairList(camera, found, measured.doubts)


def _two_lists(
    content: Mapping[str, Any], own: Rows, pixels: dict[str, Pixel], problems: ProblemList
) -> None:
    objects, images = content.get("object_points"), content.get("image_points")
    if not isinstance(objects, list) or not isinstance(images, list) or len(objects) != len(images):
        problems.add("", "object_points and image_points are not two lists of the same length")
        return
    for index, (point, pixel) in enumerate(zip(objects, images, strict=True)):
        place, click = f"object_points[{index}]", f"image_points[{index}]"
        values = numbers_of(point, (2, 3), place, problems)
        clicked = numbers_of(pixel, (2,), click, problems)
        if values is not None and clicked is not None:
            own.add(place, str(index + 1), values)
            pixels[str(index + 1)] = clicked[:2]


def _one_list(entries: Any, own: Rows, pixels: dict[str, Pixel], problems: ProblemList) -> None:
    if not isinstance(entries, list) or not entries:
        problems.add("", 'has neither a list of "pairs" nor "object_points" and "image_points"')
        return
    for index, entry in enumerate(entries):
        place = f"pairs[{index}]"
        if not isinstance(entry, dict):
            problems.add(place, f"{shown(entry)} is not an object with name and pixel")
            continue
        name = str(entry.get("name", index + 1))
        clicked = numbers_of(entry.get("pixel"), (2,), f"{place}.pixel", problems)
        if name in pixels:
            problems.add(place, f"point {shown(name)} was clicked twice")
        if clicked is not None:
            pixels[name] = clicked[:2]
        if "point" in entry:
            values = numbers_of(entry["point"], (2, 3), f"{place}.point", problems)
            if values is not None:
                own.add(place, name, values)
    if own.values and len(own.values) != len(entries):
        problems.add("", "some pairs have a point of their own and some have none")


def _named(pixels: Mapping[str, Pixel], points: PointList, problems: ProblemList) -> tuple[Pair, ...]:
    known = {point.name: point for point in points.points}
    for name in pixels.keys() - known.keys():
        problems.add("pairs", f"no measured point is named {shown(name)}")
    problems.raise_if_any()
    return tuple(Pair(name, known[name].place, pixel) for name, pixel in pixels.items())
