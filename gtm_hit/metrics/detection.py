"""Detection on the ground: MODA, MODP, precision and recall, per frame, overall, and over the radius.

A frame that only one side knows counts: its people are all missed, or all extra.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.metrics.annotations import Annotations, Floats, Ids
from gtm_hit.metrics.matching import RADIUS, match

CURVE_RADII = tuple(step / 20 for step in range(1, 21))  # 5 cm to 1 m


@dataclass(frozen=True)
class DetectionScore:
    radius: float  # metres
    frames: int
    truth: int  # annotations of the truth
    found: int  # annotations of the other side
    matched: int
    distance_sum: float  # metres, over the matched pairs

    @property
    def missed(self) -> int:
        return self.truth - self.matched

    @property
    def extra(self) -> int:
        return self.found - self.matched

    @property
    def moda(self) -> float:
        """At most 1, negative when there are more mistakes than people, NaN without truth."""
        return 1.0 - _fraction(self.missed + self.extra, self.truth)

    @property
    def modp(self) -> float:
        """1 when every match is exact, towards 0 when all are nearly `radius` off, NaN without matches."""
        return 1.0 - _fraction(self.distance_sum / self.radius, self.matched)

    @property
    def precision(self) -> float:
        return _fraction(self.matched, self.found)

    @property
    def recall(self) -> float:
        return _fraction(self.matched, self.truth)


@dataclass(frozen=True, eq=False)
class FrameScores:
    """The same numbers for each frame, arrays (F,)."""

    radius: float  # metres
    numbers: Ids  # frame numbers, ascending
    truth: Ids
    found: Ids
    matched: Ids
    distance_sums: Floats  # metres

    @property
    def moda(self) -> Floats:
        """NaN in frames without truth."""
        return 1.0 - _fractions(self.truth + self.found - 2 * self.matched, self.truth)

    @property
    def modp(self) -> Floats:
        """NaN in frames without matches."""
        return 1.0 - _fractions(self.distance_sums / self.radius, self.matched)

    @property
    def precision(self) -> Floats:
        return _fractions(self.matched, self.found)

    @property
    def recall(self) -> Floats:
        return _fractions(self.matched, self.truth)

    @property
    def worst_first(self) -> Ids:
        """Rows (F,) by the number of mistakes, then by the sum of distances, then by frame number."""
        mistakes = self.truth + self.found - 2 * self.matched
        order: Ids = np.lexsort((self.numbers, -self.distance_sums, -mistakes))
        return order

    def overall(self) -> DetectionScore:
        return DetectionScore(
            self.radius,
            len(self.numbers),
            int(self.truth.sum()),
            int(self.found.sum()),
            int(self.matched.sum()),
            float(self.distance_sums.sum()),
        )


def evaluate(truth: Annotations, found: Annotations, radius: float = RADIUS) -> DetectionScore:
    return evaluate_frames(truth, found, radius).overall()


def evaluate_frames(truth: Annotations, found: Annotations, radius: float = RADIUS) -> FrameScores:
    matches = match(truth, found, radius)
    numbers = np.union1d(truth.frames, found.frames)
    row_of_match = np.searchsorted(numbers, truth.frames[matches.truth])
    return FrameScores(
        radius,
        numbers,
        np.bincount(np.searchsorted(numbers, truth.frames), minlength=len(numbers)),
        np.bincount(np.searchsorted(numbers, found.frames), minlength=len(numbers)),
        np.bincount(row_of_match, minlength=len(numbers)),
        np.bincount(row_of_match, weights=matches.distances, minlength=len(numbers)).astype(np.float64),
    )


def curve(
    truth: Annotations, found: Annotations, radii: Iterable[float] = CURVE_RADII
) -> list[DetectionScore]:
    return [evaluate(truth, found, radius) for radius in radii]


def _fraction(part: float, whole: float) -> float:
    return part / whole if whole else float("nan")


def _fractions(part: NDArray, whole: NDArray) -> Floats:
    return np.divide(part, whole, out=np.full(len(whole), np.nan), where=whole != 0)
