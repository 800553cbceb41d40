"""Where an adjustment has come to, as it may be kept in a file or a row and taken up again."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.problem import Problem
from gtm_hit.calibration.adjustment.settings import Settings, Variant
from gtm_hit.calibration.adjustment.solver import FIRST_DAMPING

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class State:
    """Between two steps."""

    of: str  # digest of the problem, the variant and the settings it belongs to
    rows: Floats  # (C, K) the cameras' numbers
    points: Floats  # (P, 3) free, then measured points
    pass_number: int = 0
    round: int = 0  # of the pass
    walking: bool = False  # the points of this round are settled
    steps_of_round: int = 0
    steps: int = 0
    damping: float = FIRST_DAMPING
    cost: float = 0.0

    def as_json(self) -> dict[str, Any]:
        """Numbers to the last bit; None for points that nobody knows yet."""
        points = [[None if np.isnan(value) else value for value in point] for point in self.points.tolist()]
        return {**self.__dict__, "rows": self.rows.tolist(), "points": points}

    @classmethod
    def of_json(cls, content: dict[str, Any]) -> State:
        """What `as_json` made."""
        rows = np.array(content["rows"], dtype=np.float64)
        points: Floats = np.array(content["points"], dtype=np.float64).reshape(-1, 3)
        return cls(**{**content, "rows": rows, "points": points})


def digest_of(problem: Problem, variant: Variant, settings: Settings) -> str:
    """SHA-256, hex, of all that a result depends on."""
    told: dict[str, Any] = {"variant": variant.value, "settings": asdict(settings)}
    told["views"] = [
        [view.name, view.lens.width, view.lens.height, sorted(view.stays), sorted(view.sigmas.items())]
        for view in problem.views
    ]
    told["sigma"] = problem.measured_sigma
    digest = hashlib.sha256(json.dumps(told).encode())
    for view in problem.views:
        for array in (view.lens.matrix, view.lens.distortion, view.rvec, view.tvec):
            digest.update(_bytes(array))
    for seen in (problem.seen, problem.measured_seen):
        for clicked in (seen.cameras, seen.points, seen.pixels):
            digest.update(_bytes(clicked))
    for known in (problem.points, problem.measured, problem.point_sigmas, problem.weights):
        digest.update(b"none" if known is None else _bytes(known))
    return digest.hexdigest()


def _bytes(array: NDArray[Any]) -> bytes:
    return f"{array.shape}".encode() + np.ascontiguousarray(array).tobytes()
