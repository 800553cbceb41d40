"""What stitching takes for granted, in metres, seconds and frames."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields


class RulesError(ValueError):
    """A number no stitching can work with; says which."""


@dataclass(frozen=True)
class Rules:
    gate: float = 0.6  # metres two workers' places of one person may lie apart in common frames
    gap: int = 5  # frames that may lie between a track's end and its continuation
    margin: float = 3.0  # log odds against the second-best answer; less is doubtful
    return_seconds: float = 20.0  # after which nobody is proposed as the same any more
    return_reach: float = 4.0  # metres between where somebody left and where somebody came
    seconds: float = 0.5  # between neighbouring frames
    noise: float = 0.05  # metres, standard deviation of a place in X and in Y

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not math.isfinite(value) or value < 0:
                raise RulesError(f"{field.name} must be a number from 0, not {value}")
        for name in ("gate", "seconds", "noise"):
            if not getattr(self, name):
                raise RulesError(f"{name} must be more than 0")
