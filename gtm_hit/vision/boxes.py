"""Boxes that detectors draw around people in one picture."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]  # (H, W, 3), BGR
Floats = NDArray[np.float64]


class Box(NamedTuple):
    """Pixels of the picture it was found in."""

    x1: float
    y1: float
    x2: float
    y2: float
    score: float  # 0…1


class Detector(Protocol):
    """Finds people in one picture; what it found may be kept under the picture's digest and `version`."""

    @property
    def version(self) -> str:
        """Names the model and everything its boxes depend on."""

    def detect(self, image: Picture) -> list[Box]: ...


def as_array(boxes: list[Box]) -> Floats:
    """(N, 5): x1 y1 x2 y2 score."""
    return np.array(boxes, dtype=np.float64).reshape(-1, 5)


def overlaps(first: Any, second: Any) -> Floats:
    """Intersection over union, (N, M), of boxes (N, 4) and (M, 4)."""
    a, b = np.asarray(first, dtype=np.float64)[:, None, :4], np.asarray(second, dtype=np.float64)[None, :, :4]
    sides = np.minimum(a[..., 2:], b[..., 2:]) - np.maximum(a[..., :2], b[..., :2])
    common = np.prod(np.maximum(sides, 0.0), axis=-1)
    areas = [np.prod(np.maximum(each[..., 2:] - each[..., :2], 0.0), axis=-1) for each in (a, b)]
    union = areas[0] + areas[1] - common
    result: Floats = np.divide(common, union, out=np.zeros_like(common), where=union > 0)
    return result
