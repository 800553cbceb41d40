"""The pose that most pairs agree on, however wrong a few of them are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.pose_fit import Pose, Sights, candidates, errors_of, is_flat, poses, refined, subsets

Mask = NDArray[np.bool_]

OUTLYING = 8.0  # pixels of a picture 1920 wide, at which a pair contradicts the others
USUAL_WIDTH = 1920
SUBSET = 5  # pairs a hypothesis is made of: four leave the pose of a plane too loose
MOST_SUBSETS = 60
ROUNDS = 6  # of finding out who agrees and fitting again
LEAST_FOR_OUTLIERS = 6  # with fewer pairs any one of them could be the wrong one


@dataclass(frozen=True, eq=False)
class Agreement:
    """A pose and the sights it was fitted to."""

    pose: Pose
    agree: Mask  # (N,) of all sights

    @property
    def count(self) -> int:
        return int(self.agree.sum())


def agreed_pose(sights: Sights, ground: bool = True) -> Agreement | None:
    """Fitted to all sights where no one contradicts, else to the largest group that agrees."""
    everybody = np.ones(len(sights.points), dtype=bool)
    found = poses(sights, ground)
    limit = outlying(sights)
    if found and (found[0].errors.max() <= limit or len(everybody) < LEAST_FOR_OUTLIERS):
        return Agreement(found[0], everybody)
    if len(everybody) < LEAST_FOR_OUTLIERS:
        return None
    grown = (_grown(sights, start, limit, ground) for start in _starts(sights, found, limit))
    sound = [each for each in grown if each is not None]
    return max(sound, key=lambda each: (each.count, -each.pose.rms), default=None)


def outlying(sights: Sights) -> float:
    """Pixels at which a click counts as contradicting."""
    return OUTLYING * max(sights.lens.width, sights.lens.height) / USUAL_WIDTH


def _starts(sights: Sights, found: list[Pose], limit: float) -> list[Pose]:
    """The few most promising poses, by how well the better part of all sights fits them."""
    drawn, flat = list(found), is_flat(sights.points)
    for which in subsets(len(sights.points), SUBSET, MOST_SUBSETS, seed=0):
        few = sights.of(which)
        drawn += [Pose(rvec, tvec, np.zeros(0)) for rvec, tvec in candidates(few, flat)]
    scored = [
        (float(np.minimum(errors_of(sights, pose), 3 * limit).sum()), n) for n, pose in enumerate(drawn)
    ]
    return [drawn[n] for _score, n in sorted(scored)[:4]]


def _grown(sights: Sights, start: Pose, limit: float, ground: bool) -> Agreement | None:
    """Whoever agrees with the pose is fitted again, until nobody joins or leaves."""
    pose, agree = start, np.zeros(len(sights.points), dtype=bool)
    for turn in range(ROUNDS):
        # A pose of five clicks is off by more than its clicks: the first turn forgives more.
        near = errors_of(sights, pose) <= (3 * limit if turn == 0 else limit)
        if near.sum() < SUBSET or (turn > 1 and (near == agree).all()):
            break
        better = refined(sights.of(near), pose.rvec, pose.tvec)
        if better is None:
            return None
        pose, agree = better, near
    if agree.sum() < SUBSET or len(pose.errors) != agree.sum() or (ground and pose.centre[2] <= 0):
        return None
    return Agreement(pose, agree)
