"""Views as rows of numbers, in the order in which OpenCV has the derivatives of a projection."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.problem import LENS, PARAMETERS, POSE, View
from gtm_hit.calibration.lens_numbers import Lens

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

FEW = 15  # rvec tvec fx fy cx cy k1 k2 p1 p2 k3
ALL = len(PARAMETERS)  # with k4 k5 k6 of the rational model


def packed(views: Sequence[View]) -> Floats:
    """(C, K) numbers, K being 18 where a lens is rational and 15 otherwise."""
    width = ALL if any(view.lens.distortion.size > 5 for view in views) else FEW
    rows = np.zeros((len(views), width))
    for row, view in zip(rows, views, strict=True):
        matrix = view.lens.matrix
        numbers = (matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2], *view.lens.distortion)
        row[:3], row[3:6], row[6 : 6 + len(numbers)] = view.rvec, view.tvec, numbers
    return rows


def unpacked(rows: Floats, before: Sequence[View]) -> tuple[View, ...]:
    """Views with the numbers of `rows`, each lens with as many coefficients as it had."""
    return tuple(
        replace(view, lens=_lens_of_row(row, view.lens), rvec=row[:3].copy(), tvec=row[3:6].copy())
        for row, view in zip(rows, before, strict=True)
    )


def _lens_of_row(row: Floats, before: Lens) -> Lens:
    matrix = np.array([[row[6], 0.0, row[8]], [0.0, row[7], row[9]], [0.0, 0.0, 1.0]])
    return Lens(before.width, before.height, matrix, row[10 : 10 + before.distortion.size].copy())


def free_flags(views: Sequence[View], lenses: bool, width: int) -> Flags:
    """(C, K) which numbers may move; with `lenses` false only poses."""
    flags = np.zeros((len(views), width), dtype=bool)
    for row, view in zip(flags, views, strict=True):
        coefficients = 10 + view.lens.distortion.size
        row[: coefficients if lenses else len(POSE)] = True
        row[[place for place in places(view.stays) if place < width]] = False
    return flags


def places(names: Sequence[str] | frozenset[str]) -> list[int]:
    """Places of parameters by their names; `pose` and `lens` are all of theirs."""
    wanted = set(names)
    if "pose" in wanted:
        wanted |= set(POSE)
    if "lens" in wanted:
        wanted |= set(LENS)
    return [place for place, name in enumerate(PARAMETERS) if name in wanted]
