"""The shift on the ground as a drawing: one outline for each class of centimetres."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.comparing import Cells

Floats = NDArray[np.float64]

EDGES = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)  # cm; the same in every map, so that maps can be compared


@dataclass(frozen=True)
class Band:
    """Cells whose shift lies in one class."""

    index: int  # from 0, the smallest
    words: str
    cells: int
    percent: float  # of the cells that are seen
    path: str  # of an SVG, in metres; empty where there is no such cell


def bands(cm: Floats, cells: Cells) -> list[Band]:
    """Of shifts (rows, columns).

    The longer side of the ground runs to the right: a ground longer along Y is turned, Y then runs to the
    right and X downwards; otherwise X runs to the right and Y upwards.
    """
    classes = np.where(np.isnan(cm), -1, np.searchsorted(EDGES, cm, side="right"))
    seen = max(int((classes >= 0).sum()), 1)
    page = classes if cells.grid.rows > cells.grid.columns else classes[::-1].T
    found = []
    for index, words in enumerate(class_words()):
        count = int((classes == index).sum())
        path = "".join(_runs(page == index, cells))
        found.append(Band(index, words, count, 100 * count / seen, path))
    return found


def class_words() -> list[str]:
    inner = [f"{low:g} to {high:g} cm" for low, high in pairwise(EDGES)]
    return [f"below {EDGES[0]:g} cm", *inner, f"{EDGES[-1]:g} cm or more"]


def _runs(mask: NDArray[np.bool_], cells: Cells) -> Iterator[str]:
    """Cells one below the other become one rectangle. `mask` is (across, down) on the page."""
    width, height = mask.shape
    long_side, short_side = max(cells.grid.extent), min(cells.grid.extent)
    upwards = cells.grid.rows <= cells.grid.columns
    for across in range(width):
        line = np.flatnonzero(np.diff(np.concatenate(([0], mask[across].astype(np.int8), [0]))))
        left, right = across * cells.side, min((across + 1) * cells.side, long_side)
        for start, stop in line.reshape(-1, 2).tolist():
            top, bottom = _down(start, stop, height, upwards, cells.side, short_side)
            yield f"M{left:.6g} {top:.6g}H{right:.6g}V{bottom:.6g}H{left:.6g}Z"


def _down(
    start: int, stop: int, count: int, upwards: bool, side: float, extent: float
) -> tuple[float, float]:
    """Metres from the top; a cut cell is at the end of the axis, which is the top where it runs upwards."""
    if not upwards:
        return start * side, min(stop * side, extent)
    return max(extent - (count - start) * side, 0.0), extent - (count - stop) * side
