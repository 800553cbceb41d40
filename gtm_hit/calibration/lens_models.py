"""How many numbers a lens is given: what OpenCV may solve, and what it leaves alone."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import cv2


class Coefficients(StrEnum):
    """Which of the lens's numbers are solved."""

    FIVE = "five"  # k1 k2 p1 p2 k3
    FOUR = "four"  # k1 k2 p1 p2
    TWO = "two"  # k1 k2
    ONE = "one"  # k1
    NONE = "none"
    RATIONAL = "rational"  # k1 k2 p1 p2 k3 k4 k5 k6


NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")

_TANGENTIAL = {Coefficients.FIVE, Coefficients.FOUR, Coefficients.RATIONAL}
_FIXED = {
    Coefficients.FIVE: 0,
    Coefficients.FOUR: cv2.CALIB_FIX_K3,
    Coefficients.TWO: cv2.CALIB_FIX_K3,
    Coefficients.ONE: cv2.CALIB_FIX_K3 | cv2.CALIB_FIX_K2,
    Coefficients.NONE: cv2.CALIB_FIX_K3 | cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K1,
    Coefficients.RATIONAL: cv2.CALIB_RATIONAL_MODEL,
}
_SOLVED = {
    Coefficients.FIVE: ("k1", "k2", "p1", "p2", "k3"),
    Coefficients.FOUR: ("k1", "k2", "p1", "p2"),
    Coefficients.TWO: ("k1", "k2"),
    Coefficients.ONE: ("k1",),
    Coefficients.NONE: (),
    Coefficients.RATIONAL: ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"),
}


@dataclass(frozen=True)
class LensModel:
    coefficients: Coefficients = Coefficients.FIVE
    fixed_centre: bool = False  # the principal point stays in the middle of the picture
    fixed_aspect: bool = False  # fx = fy

    def __post_init__(self) -> None:
        object.__setattr__(self, "coefficients", Coefficients(self.coefficients))

    @property
    def length(self) -> int:
        """How many numbers the distortion has in a file."""
        return 8 if self.coefficients is Coefficients.RATIONAL else 5

    @property
    def flags(self) -> int:
        """OpenCV's."""
        flags = _FIXED[self.coefficients]
        flags |= 0 if self.coefficients in _TANGENTIAL else cv2.CALIB_ZERO_TANGENT_DIST
        flags |= cv2.CALIB_FIX_PRINCIPAL_POINT if self.fixed_centre else 0
        return flags | (cv2.CALIB_FIX_ASPECT_RATIO if self.fixed_aspect else 0)

    @property
    def solved(self) -> tuple[str, ...]:
        """The parameters that are found, not given."""
        centre = () if self.fixed_centre else ("cx", "cy")
        return ("fx", "fy", *centre, *_SOLVED[self.coefficients])

    def as_json(self) -> dict[str, Any]:
        return {
            "coefficients": self.coefficients.value,
            "fixed_centre": self.fixed_centre,
            "fixed_aspect": self.fixed_aspect,
        }
