"""Which pairs are wrong, and how: each suspicion is tested by solving with it mended."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.pose_fit import Pose, Sights, errors_of, poses, refined
from gtm_hit.calibration.pose_robust import outlying
from gtm_hit.calibration.pose_values import Finding, Trouble

Mask = NDArray[np.bool_]

ENOUGH = 8  # pairs: 4 are off by metres now and then, 8 by 4 cm
SMALL_HULL = 0.05  # of the picture
LOW, HIGH = 0.3, 80.0  # metres above the ground at which hardly any camera stands
UNITS = ((100.0, "centimetres"), (1000.0, "millimetres"))
ROUND = (1.0, 0.5, 0.1, 0.05, 0.01)  # metres; slips of the keyboard are round
SIGMAS = 3.0  # of the other pairs' misses by which a mended pair may be off
NEARLY = 0.5  # a second pose this much worse at most, relatively, is worth telling
APART = 0.25  # metres between two centres worth telling


def findings_of(
    sights: Sights, names: Sequence[str], pose: Pose, known: Mask, used: Mask
) -> tuple[Finding, ...]:
    """Everything a person should look at, the most telling first; `known` are those within the fold."""
    wrong = known & ~used
    found = [
        *_unit(pose),
        *_mistakes(sights, names, pose, wrong, used),
        *_folded(names, known),
        *_second_pose(sights.of(used), pose),
        *_few(int(used.sum())),
        *_small_hull(sights.of(used)),
    ]
    return tuple(found)


def interchanged(sights: Sights) -> str:
    """What is to be said when the pairs fit with X and Y the other way round; empty when they don't."""
    turned = replace(sights, points=sights.points[:, [1, 0, 2]])
    best = next(iter(poses(turned)), None)
    fits = best is not None and best.errors.max() <= 2 * outlying(sights)
    return "X and Y look interchanged" if fits else ""


def _unit(pose: Pose) -> Iterator[Finding]:
    height = float(pose.centre[2])
    for scale, unit in UNITS:
        if height > HIGH and LOW <= height / scale <= HIGH / 2:
            told = f"the camera would stand {height:.0f} m above the ground"
            yield Finding(Trouble.UNIT, f"This looks like {unit}: {told}, in {unit} {height / scale:.2f} m.")
            return
    for scale, unit in UNITS:
        if height < LOW and LOW <= height * scale <= HIGH / 2:
            told = f"the camera would stand {height * 100:.1f} cm above the ground"
            better = f"in metres {height * scale:.2f} m"
            yield Finding(Trouble.UNIT, f"This looks like metres read as {unit}: {told}, {better}.")
            return


def _mistakes(sights: Sights, names: Sequence[str], pose: Pose, wrong: Mask, used: Mask) -> Iterator[Finding]:
    left = [int(index) for index in np.flatnonzero(wrong)]
    for first, second in _swapped(sights, pose, left, used):
        if first in left and second in left:
            left = [index for index in left if index not in (first, second)]
            pair = (names[first], names[second])
            yield Finding(Trouble.SWAPPED, f"Pairs {pair[0]} and {pair[1]} look swapped.", pair)
    for index in left:
        yield _mistake(sights, names, pose, index, used)


def _swapped(sights: Sights, pose: Pose, wrong: list[int], used: Mask) -> list[tuple[int, int]]:
    """Two at a time whose clicks fit when they are exchanged, best first."""
    fitting = []
    for first, second in itertools.combinations(wrong, 2):
        pixels = sights.pixels.copy()
        pixels[[first, second]] = pixels[[second, first]]
        worst = _mended(replace(sights, pixels=pixels), pose, used, [first, second])
        if worst <= outlying(sights):
            fitting.append((worst, first, second))
    return [(first, second) for _worst, first, second in sorted(fitting)]


def _mended(sights: Sights, pose: Pose, used: Mask, which: list[int]) -> float:
    """Pixels by which the mended pairs are off once all are solved with them."""
    agree = used.copy()
    agree[which] = True
    # The quick look first: what is far off before fitting does not come near by it.
    if errors_of(sights.of(np.array(which)), pose).max() > 4 * outlying(sights):
        return np.inf
    better = refined(sights.of(agree), pose.rvec, pose.tvec)
    if better is None or better.errors.max() > outlying(sights):
        return np.inf
    return float(errors_of(sights.of(np.array(which)), better).max())


def _mistake(sights: Sights, names: Sequence[str], pose: Pose, index: int, used: Mask) -> Finding:
    """What is wrong with one pair that contradicts the others."""
    name = names[index]
    off = float(errors_of(sights.of(np.array([index])), pose)[0])
    if told := _typed(sights, pose, index, used):
        return Finding(
            Trouble.COORDINATE, f"{told[0]} of point {name} looks wrong by {told[1]:.2f} m.", (name,)
        )
    if unit := _other_unit(sights, pose, index, used):
        return Finding(Trouble.UNIT, f"Point {name} looks like {unit}, unlike the others.", (name,))
    if (other := _clicked_instead(sights, pose, index)) is not None:
        text = f"The click of pair {name} lies where point {names[other]} is expected."
        return Finding(Trouble.CLICK, text, (name, names[other]))
    told_off = f"{off:.0f} px off" if np.isfinite(off) else "behind the camera"
    text = f"Pair {name} contradicts the others ({told_off}): click it again or check its coordinates."
    return Finding(Trouble.OUTLIER, text, (name,))


def _other_unit(sights: Sights, pose: Pose, index: int, used: Mask) -> str:
    for scale, unit in UNITS:
        for factor, told in ((1 / scale, unit), (scale, f"metres read as {unit}")):
            points = sights.points.copy()
            points[index] *= factor
            far = np.linalg.norm(points[index] - sights.points[index]) > 0
            if far and _mended(replace(sights, points=points), pose, used, [index]) <= outlying(sights):
                return told
    return ""


def _typed(sights: Sights, pose: Pose, index: int, used: Mask) -> tuple[str, float] | None:
    """The one coordinate that explains the click when it is changed, and by how many metres it is wrong."""
    fits = []
    for axis, letter in enumerate("XYZ"):
        for roundness, change in enumerate(_changes(sights, pose, index, axis)):
            points = sights.points.copy()
            points[index, axis] += change
            worst = _mended(replace(sights, points=points), pose, used, [index])
            fits.append((roundness, round(abs(change), 6), worst, letter))
    least = min((worst for _round, _by, worst, _letter in fits), default=np.inf)
    if least > outlying(sights):
        return None
    # Of all that explain the click as well as the others fit, the roundest, then smallest, is the likeliest slip.
    enough = np.hypot(least, SIGMAS * max(pose.rms, 0.5))
    _round, by, _worst, letter = min(each for each in fits if each[2] <= enough)
    return letter, by


def _changes(sights: Sights, pose: Pose, index: int, axis: int) -> list[float]:
    """Metres along one axis that bring the point to its click, the roundest number first."""
    best = _best_change(sights, pose, index, axis)
    return [] if best is None else [*(round(best / size) * size for size in ROUND), best]


def _best_change(sights: Sights, pose: Pose, index: int, axis: int) -> float | None:
    """Metres along one axis after which the point is seen nearest to its click."""
    along = np.linspace(-12.0, 12.0, 2401)
    points = np.repeat(sights.points[index][None], len(along), axis=0)
    points[:, axis] += along
    lens = sights.lens
    pixels = cv2.projectPoints(points, pose.rvec, pose.tvec, lens.matrix, lens.distortion)[0].reshape(-1, 2)
    before = points @ cv2.Rodrigues(pose.rvec)[0][2] + pose.tvec[2] > 0
    off = np.where(before, np.hypot(*(pixels - sights.pixels[index]).T), np.inf)
    nearest = int(np.argmin(off))
    return float(along[nearest]) if off[nearest] <= 2 * outlying(sights) else None


def _clicked_instead(sights: Sights, pose: Pose, index: int) -> int | None:
    """The other point that is expected at this click."""
    lens = sights.lens
    expected = cv2.projectPoints(sights.points, pose.rvec, pose.tvec, lens.matrix, lens.distortion)[0]
    off = np.hypot(*(expected.reshape(-1, 2) - sights.pixels[index]).T)
    off[index] = np.inf
    nearest = int(np.argmin(off))
    return nearest if off[nearest] <= outlying(sights) else None


def _folded(names: Sequence[str], known: Mask) -> Iterator[Finding]:
    folded = tuple(name for name, within in zip(names, known, strict=True) if not within)
    if folded:
        text = f"The lens has no answer where {', '.join(folded)} was clicked; left out."
        yield Finding(Trouble.FOLD, text, folded)


def _second_pose(sights: Sights, pose: Pose) -> Iterator[Finding]:
    for other in poses(sights):
        apart = float(np.linalg.norm(other.centre - pose.centre))
        if apart > APART and other.rms <= pose.rms * (1 + NEARLY) + NEARLY:
            text = (
                f"A second pose, {apart:.1f} m away, explains these pairs nearly as well: "
                "add points farther from each other, or off the ground."
            )
            yield Finding(Trouble.TWO_POSES, text)
            return


def _few(count: int) -> Iterator[Finding]:
    if count < ENOUGH:
        yield Finding(Trouble.FEW, f"Only {count} pairs agree; from {ENOUGH} on a wrong one stands out.")


def _small_hull(sights: Sights) -> Iterator[Finding]:
    hull = cv2.convexHull(sights.pixels.astype(np.float32))
    share = float(cv2.contourArea(hull)) / (sights.lens.width * sights.lens.height)
    if share < SMALL_HULL:
        text = f"The clicks cover only {100 * share:.1f} % of the picture: add points farther apart."
        yield Finding(Trouble.HULL, text)
