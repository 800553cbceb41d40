"""Which pairs are wrong, and how: each suspicion is tested by solving with it mended."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from gtm_hit.calibration.pose_fit import Floats, Mask, Pose, Sights, errors_of, refined
from gtm_hit.calibration.pose_values import Finding, Trouble

UNITS = ((100.0, "centimetres"), (1000.0, "millimetres"))
ROUND = (1.0, 0.5, 0.1, 0.05, 0.01)  # metres; slips of the keyboard are round
LARGE = 3.0  # limits; a smaller miss lies beside some place of a coordinate's line by chance
SURE = 2  # roundnesses that are a slip all the same: 1 m and 0.5 m


@dataclass(frozen=True, eq=False)
class Case:
    """A pose, the sights it was fitted to (`used`) and all others."""

    sights: Sights
    names: Sequence[str]
    pose: Pose
    used: Mask
    limit: float  # pixels at which a click contradicts

    def miss(self, index: int) -> float:
        return float(errors_of(self.sights.of(np.array([index])), self.pose)[0])

    def expected(self, points: Floats) -> Floats:
        """(N, 2) pixels; infinite for points not before the camera."""
        lens, pose = self.sights.lens, self.pose
        pixels = cv2.projectPoints(points, pose.rvec, pose.tvec, lens.matrix, lens.distortion)[0]
        before = points @ cv2.Rodrigues(pose.rvec)[0][2] + pose.tvec[2] > 0
        return np.where(before[:, None], pixels.reshape(-1, 2), np.inf)


def mistakes(case: Case, wrong: Mask) -> Iterator[Finding]:
    """What is wrong with each pair that contradicts: two of them exchanged, or one by itself."""
    left = [int(index) for index in np.flatnonzero(wrong)]
    for first, second in _swapped(case, left):
        if first in left and second in left:
            left = [index for index in left if index not in (first, second)]
            pair = (case.names[first], case.names[second])
            yield Finding(Trouble.SWAPPED, f"Pairs {pair[0]} and {pair[1]} look swapped.", pair)
    for index in left:
        yield _mistake(case, index)


def _swapped(case: Case, wrong: list[int]) -> list[tuple[int, int]]:
    """Two at a time whose clicks fit when they are exchanged, best first."""
    fitting = []
    for first, second in itertools.combinations(wrong, 2):
        pixels = case.sights.pixels.copy()
        pixels[[first, second]] = pixels[[second, first]]
        worst = _mended(case, replace(case.sights, pixels=pixels), [first, second])
        if worst <= case.limit:
            fitting.append((worst, first, second))
    return [(first, second) for _worst, first, second in sorted(fitting)]


def _mended(case: Case, sights: Sights, which: list[int]) -> float:
    """Pixels by which the mended pairs miss once solved with; infinite where that spoils others."""
    agree = case.used.copy()
    agree[which] = True
    # The quick look first: what is far off before fitting does not come near by it.
    if errors_of(sights.of(np.array(which)), case.pose).max() > 4 * case.limit:
        return np.inf
    better = refined(sights.of(agree), case.pose.rvec, case.pose.tvec)
    if better is None or better.errors.max() > case.limit:
        return np.inf
    return float(errors_of(sights.of(np.array(which)), better).max())


def _mended_point(case: Case, index: int, point: Floats) -> float:
    points = case.sights.points.copy()
    points[index] = point
    return _mended(case, replace(case.sights, points=points), [index])


def _mistake(case: Case, index: int) -> Finding:
    """What is wrong with one pair that contradicts the others."""
    name = case.names[index]
    if told := _typed(case, index):
        text = f"{told[0]} of point {name} looks wrong by {told[1]:.2f} m."
        return Finding(Trouble.COORDINATE, text, (name,))
    if unit := _other_unit(case, index):
        return Finding(Trouble.UNIT, f"Point {name} looks like {unit}, unlike the others.", (name,))
    if (other := _clicked_instead(case, index)) is not None:
        text = f"The click of pair {name} lies where point {case.names[other]} is expected."
        return Finding(Trouble.CLICK, text, (name, case.names[other]))
    off = case.miss(index)
    told_off = f"{off:.0f} px off" if np.isfinite(off) else "behind the camera"
    text = f"Pair {name} contradicts the others ({told_off}): click it again or check its coordinates."
    return Finding(Trouble.OUTLIER, text, (name,))


def _other_unit(case: Case, index: int) -> str:
    point = case.sights.points[index]
    for scale, unit in UNITS:
        for factor, told in ((1 / scale, unit), (scale, f"metres read as {unit}")):
            if point.any() and _mended_point(case, index, factor * point) <= case.limit:
                return told
    return ""


def _typed(case: Case, index: int) -> tuple[str, float] | None:
    """The one coordinate that explains the click when it is changed, and by how many metres it is wrong."""
    fits = []
    # Nobody mistypes the height of a single point where all lie at one height.
    axes = 3 if np.ptp(case.sights.points[:, 2]) > 0 else 2
    for axis in range(axes):
        for roundness, change in enumerate(_changes(case, index, axis)):
            point = case.sights.points[index] + change * np.eye(3)[axis]
            if _mended_point(case, index, point) <= case.limit:
                fits.append((roundness, round(abs(change), 6), "XYZ"[axis]))
    if not fits:
        return None
    # Of all that explain the click, the roundest change is the likeliest slip, then the smallest.
    roundness, by, letter = min(fits)
    return (letter, by) if roundness < SURE or case.miss(index) > LARGE * case.limit else None


def _changes(case: Case, index: int, axis: int) -> list[float]:
    """Metres along one axis that bring the point to its click, the roundest number first."""
    along = np.linspace(-12.0, 12.0, 2401)
    points = case.sights.points[index] + along[:, None] * np.eye(3)[axis]
    off = np.hypot(*(case.expected(points) - case.sights.pixels[index]).T)
    nearest = int(np.argmin(off))
    if off[nearest] > 2 * case.limit:
        return []
    best = float(along[nearest])
    return [*(round(best / size) * size for size in ROUND), best]


def _clicked_instead(case: Case, index: int) -> int | None:
    """The other point that is expected at this click."""
    off = np.hypot(*(case.expected(case.sights.points) - case.sights.pixels[index]).T)
    off[index] = np.inf
    nearest = int(np.argmin(off))
    return nearest if off[nearest] <= case.limit else None
