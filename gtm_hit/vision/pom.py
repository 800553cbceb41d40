"""The probabilistic occupancy map (Fleuret et al., PAMI 2008): who stands where, from the foreground alone.

Every position is occupied or not, independently a posteriori. The picture that a set of people would give is
the union of their rectangles; the probabilities are those under which the average of such pictures differs
least from the foreground. They are found by repeating the mean field equations.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Floats

Ints = NDArray[np.int64]
NEVER_SURE = 1e-6


@dataclass(frozen=True)
class PomSettings:
    sigma: float = 0.002  # how far foreground and average may differ
    prior: float = 0.001  # of a position to be occupied; the crowd that is expected must not fill the views
    rounds: int = 60
    inertia: float = 0.8  # of the probabilities from round to round, or they swing
    width: int = 320  # pixels that views are shrunk to
    occupied: float = 0.5  # probability from which somebody stands there
    apart: float = 0.5  # metres between two people
    step: float = 0.20  # metres between positions


class Frames:
    """The rectangles of all positions in one view, shrunk: made once for many frames."""

    def __init__(self, boxes: NDArray[np.int16], size: tuple[int, int], width: int) -> None:
        scale = width / size[0]
        self.shape = (max(1, round(size[1] * scale)), width)
        edges = np.rint(boxes.astype(np.float64) * scale).astype(np.int64)
        edges[:, [0, 2]] = np.clip(edges[:, [0, 2]], 0, self.shape[1])
        edges[:, [1, 3]] = np.clip(edges[:, [1, 3]], 0, self.shape[0])
        self.edges: Ints = edges
        self.area: Floats = ((edges[:, 2] - edges[:, 0]) * (edges[:, 3] - edges[:, 1])).astype(np.float64)

    def sums(self, image: NDArray) -> Floats:
        """Sum of the image over each rectangle, (N,)."""
        table = cv2.integral(np.ascontiguousarray(image, dtype=np.float64))
        x1, y1, x2, y2 = self.edges.T
        total: Floats = table[y2, x2] - table[y1, x2] - table[y2, x1] + table[y1, x1]
        return total

    def painted(self, values: Floats) -> Floats:
        """Picture in which each pixel is the sum of the values of the rectangles over it."""
        corners = np.zeros((self.shape[0] + 1, self.shape[1] + 1))
        x1, y1, x2, y2 = self.edges.T
        for rows, columns, sign in ((y1, x1, 1), (y1, x2, -1), (y2, x1, -1), (y2, x2, 1)):
            np.add.at(corners, (rows, columns), sign * values)
        painted: Floats = corners.cumsum(axis=0).cumsum(axis=1)[:-1, :-1]
        return painted


def occupancy(
    views: Mapping[str, Frames], foreground: Mapping[str, NDArray], settings: PomSettings
) -> Floats:
    """Probability of every position to be occupied, (N,)."""
    count = len(next(iter(views.values())).area)
    chance = np.full(count, settings.prior)
    odds = np.log((1 - settings.prior) / settings.prior)
    binary = {
        name: (cv2.resize(mask.astype(np.float32), view.shape[::-1], interpolation=cv2.INTER_AREA) > 0.6)
        for name, view in views.items()
        if (mask := foreground.get(name)) is not None
    }
    for _ in range(settings.rounds):
        energy = np.full(count, odds)
        for name, mask in binary.items():
            energy += _difference(views[name], mask.astype(np.float64), chance) / settings.sigma
        new = 1 / (1 + np.exp(np.clip(energy, -50, 50)))
        chance = settings.inertia * chance + (1 - settings.inertia) * new
    return chance


def _difference(view: Frames, mask: Floats, chance: Floats) -> Floats:
    """By how much a view differs more with each position occupied than with it empty, (N,)."""
    empty = np.log(1 - np.minimum(chance, 1 - NEVER_SURE))
    average = 1 - np.exp(view.painted(empty))
    wrong = np.abs(mask - average).sum()
    filled = average.sum()
    there = view.sums(mask)  # |B| inside each rectangle
    inside, common = view.sums(average), view.sums(mask * average)
    # Inside its rectangle the average is 1 with the position occupied, and 1 - (1 - A) / (1 - q) without.
    shrink = 1 / np.exp(empty)
    inside_without = view.area - (view.area - inside) * shrink
    common_without = there - (there - common) * shrink
    now = inside + there - 2 * common
    without = wrong - now + inside_without + there - 2 * common_without
    occupied = wrong - now + view.area - there
    filled_without = np.maximum(filled - inside + inside_without, 1.0)
    filled_with = np.maximum(filled - inside + view.area, 1.0)
    return np.where(view.area > 0, occupied / filled_with - without / filled_without, 0.0)


def peaks(xy: Floats, chance: Floats, settings: PomSettings) -> list[int]:
    """Positions that are likely occupied and the likeliest around."""
    taken: list[int] = []
    for row in np.argsort(-chance, kind="stable"):
        if chance[row] < settings.occupied:
            break
        if all(np.hypot(*(xy[row] - xy[other])) >= settings.apart for other in taken):
            taken.append(int(row))
    return taken
