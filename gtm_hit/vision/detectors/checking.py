"""What detectors of others answer is checked before anything is built on it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from gtm_hit.vision.boxes import Box
from gtm_hit.vision.detectors.errors import DetectorError
from gtm_hit.vision.located import Located

MOST = 2000  # boxes of a picture, people of a frame: whoever says more is broken
BEYOND = 0.25  # share of the picture by which a box may reach out of it before it is cut
FURTHEST = 10_000.0  # metres; nobody marks people further away


def as_list(answer: Any, what: str) -> list[Any]:
    """The answer, if it is a list of a sensible length; generators are read no further than that."""
    if isinstance(answer, (str, bytes, dict)) or not isinstance(answer, Iterable):
        raise DetectorError(f"the detector answers {type(answer).__name__} where a list of {what} belongs")
    found: list[Any] = []
    for each in answer:
        if len(found) == MOST:
            raise DetectorError(f"the detector answers more than {MOST} {what}")
        found.append(each)
    return found


def checked_box(sides: Sequence[Any], score: Any, size: tuple[int, int]) -> Box | None:
    """A box cut at the border of a picture of `size`, width and height; None where nothing of it is left."""
    if isinstance(sides, (str, bytes)) or len(sides) != 4:
        raise DetectorError(f"a box has 4 sides, not {len(sides)}")
    x1, y1, x2, y2 = (number(side, "a side of a box") for side in sides)
    if x2 < x1 or y2 < y1:
        raise DetectorError(f"the box {x1:g}, {y1:g}, {x2:g}, {y2:g} ends before it begins")
    width, height = size
    if min(x1 / width, y1 / height, 1 - x2 / width, 1 - y2 / height) < -BEYOND:
        raise DetectorError(f"the box {x1:g}, {y1:g}, {x2:g}, {y2:g} is not in a picture of {width}×{height}")
    box = Box(max(x1, 0.0), max(y1, 0.0), min(x2, float(width)), min(y2, float(height)), share(score))
    return box if box.x2 > box.x1 and box.y2 > box.y1 else None


def checked_place(x: Any, y: Any, score: Any) -> Located:
    place = Located(number(x, "a place"), number(y, "a place"), share(score))
    if max(abs(place.x), abs(place.y)) > FURTHEST:
        raise DetectorError(f"the place {place.x:g}, {place.y:g} is out of this world: metres are meant")
    return place


def share(score: Any) -> float:
    value = number(score, "a score")
    if not 0 <= value <= 1:
        raise DetectorError(f"a score is from 0 to 1, not {value:g}")
    return value


def number(value: Any, what: str) -> float:
    """Also of text, in which some detectors write their numbers."""
    try:
        found = math.nan if isinstance(value, bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        found = math.nan
    if not math.isfinite(found):
        raise DetectorError(f"{what} is {str(value)[:40]!r}, which is no number")
    return found
