"""What a person should look at before trusting a pose."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import cv2
import numpy as np

from gtm_hit.calibration.pose_fit import Mask, Pose, Sights, poses
from gtm_hit.calibration.pose_mistakes import UNITS, Case, mistakes
from gtm_hit.calibration.pose_robust import USUAL_WIDTH, Agreement, outlying
from gtm_hit.calibration.pose_values import Finding, Trouble

ENOUGH = 8  # pairs: 4 are off by metres now and then, 8 by 4 cm
SMALL_HULL = 0.03  # of the picture
LOW, HIGH = 0.3, 80.0  # metres above the ground at which hardly any camera stands
NEARLY = 0.5  # a second pose this much worse at most, relatively, is worth telling
APART = 0.25  # metres between two centres worth telling
MANY = 0.15  # of all pairs contradicting: more than slips
LOOSE = 4.0  # pixels of a picture 1920 wide; with a good lens the published clicks have 0.9 to 2.2


def findings_of(sights: Sights, names: Sequence[str], found: Agreement, known: Mask) -> tuple[Finding, ...]:
    """All findings, the most telling first; `known` are the sights within the lens's fold."""
    used = known.copy()
    used[known] = found.agree
    pose = found.pose
    wrong = list(mistakes(Case(sights, names, pose, used, found.limit), known & ~used))
    told = [
        *_unit(pose),
        *wrong,
        *_lens(sights, pose, wrong, int(known.sum())),
        *_folded(names, known),
        *_second_pose(sights.of(used), pose),
        *_few(int(used.sum())),
        *_small_hull(sights.of(used)),
    ]
    return tuple(told)


def interchanged(sights: Sights) -> str:
    """What is to be said when the pairs fit with X and Y the other way round; empty when they don't."""
    turned = replace(sights, points=sights.points[:, [1, 0, 2]])
    best = next(iter(poses(turned)), None)
    fits = best is not None and best.errors.max() <= outlying(sights, best.errors)
    return "X and Y look interchanged" if fits else ""


def _lens(sights: Sights, pose: Pose, wrong: Sequence[Finding], count: int) -> Iterator[Finding]:
    unexplained = sum(each.trouble is Trouble.OUTLIER for each in wrong)
    if unexplained >= 3 and unexplained > MANY * count:
        text = f"{unexplained} of {count} pairs contradict the others: is this the lens of this camera?"
        yield Finding(Trouble.LENS, text)
    elif pose.rms > LOOSE * sights.lens.width / USUAL_WIDTH:
        text = f"The clicks miss by {pose.rms:.1f} px (RMS), twice what care gives: is the lens right?"
        yield Finding(Trouble.LENS, text)


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
