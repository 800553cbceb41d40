"""A person's size, and the rule that turns eight projected corners into a rectangle's foot."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum


class CylinderError(ValueError):
    """A radius or height no person has."""


@dataclass(frozen=True)
class Cylinder:
    radius: float  # metres
    height: float  # metres

    def __post_init__(self) -> None:
        for name in ("radius", "height"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise CylinderError(f"{name} must be a positive number of metres, not {value}")


class FootRule(StrEnum):
    """Where a rectangle ends at the bottom; the two published data sets differ (see `rectangles`)."""

    CORNERS = "corners"  # WILDTRACK
    CENTRE = "centre"  # MultiviewX
