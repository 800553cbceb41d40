"""What forms and requests may say about boards and models, by the names they are known by."""

from __future__ import annotations

from typing import Any

from gtm_hit.calibration.boards import DICTIONARIES as _DICTIONARIES
from gtm_hit.calibration.boards import BoardKind
from gtm_hit.calibration.lens_models import Coefficients, LensModel

KINDS = [
    (BoardKind.CHESSBOARD.value, "chessboard: inner corners"),
    (BoardKind.CIRCLES.value, "circles: a square grid"),
    (BoardKind.ACIRCLES.value, "circles: every other row shifted"),
    (BoardKind.CHARUCO.value, "ChArUco: squares"),
]
DICTIONARIES = [(name, name) for name in _DICTIONARIES]
COEFFICIENTS = [
    (Coefficients.FIVE.value, "five: k1 k2 p1 p2 k3"),
    (Coefficients.FOUR.value, "four: k1 k2 p1 p2"),
    (Coefficients.TWO.value, "two: k1 k2"),
    (Coefficients.ONE.value, "one: k1"),
    (Coefficients.NONE.value, "none"),
    (Coefficients.RATIONAL.value, "rational: eight, for wide lenses"),
]


def model_of(given: dict[str, Any]) -> LensModel:
    return LensModel(
        Coefficients(given["coefficients"]), bool(given["fixed_centre"]), bool(given["fixed_aspect"])
    )
