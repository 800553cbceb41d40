"""The pose that most pairs agree on, however wrong a few of them are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gtm_hit.calibration.pose_fit import (
    Floats,
    Mask,
    Pose,
    Sights,
    candidates,
    errors_of,
    is_flat,
    poses,
    refined,
    subsets,
)

OUTLYING = (5.5, 16.0)  # pixels of a picture 1920 wide: a pair nearer never contradicts, one farther always
SIGMAS = 6.0  # of the usual miss, between these two
USUAL_WIDTH = 1920
MEDIAN = 1.1774  # a miss's median length by its standard deviation along one axis
SUBSET = 5  # pairs a hypothesis is made of: four leave the pose of a plane too loose
MOST_SUBSETS = 60
ROUNDS = 6  # of finding out who agrees and fitting again
LEAST_FOR_OUTLIERS = 6  # with fewer pairs any one of them could be the wrong one


@dataclass(frozen=True, eq=False)
class Agreement:
    """A pose and the sights it was fitted to."""

    pose: Pose
    agree: Mask  # (N,) of all sights
    limit: float  # pixels at which a click contradicts it

    @property
    def count(self) -> int:
        return int(self.agree.sum())


def agreed_pose(sights: Sights, ground: bool = True) -> Agreement | None:
    """Fitted to all sights where no one contradicts, else to the largest group that agrees."""
    everybody = np.ones(len(sights.points), dtype=bool)
    found = poses(sights, ground)
    limit = outlying(sights, found[0].errors) if found else outlying(sights, np.zeros(1))
    if found and (found[0].errors.max() <= limit or len(everybody) < LEAST_FOR_OUTLIERS):
        return Agreement(found[0], everybody, limit)
    if len(everybody) < LEAST_FOR_OUTLIERS:
        return None
    grown = (_grown(sights, start, ground) for start in _starts(sights, found))
    sound = [each for each in grown if each is not None]
    return max(sound, key=lambda each: (each.count, -each.pose.rms), default=None)


def outlying(sights: Sights, errors: Floats) -> float:
    """Pixels at which a click contradicts, where most clicks miss by `errors`."""
    scale = max(sights.lens.width, sights.lens.height) / USUAL_WIDTH
    nearest, farthest = OUTLYING
    return scale * float(np.clip(SIGMAS * np.median(errors) / MEDIAN / scale, nearest, farthest))


def _starts(sights: Sights, found: list[Pose]) -> list[Pose]:
    """The few most promising poses, by how well the better part of all sights fits them."""
    drawn, flat = list(found), is_flat(sights.points)
    for which in subsets(len(sights.points), SUBSET, MOST_SUBSETS, seed=0):
        few = sights.of(which)
        drawn += [Pose(rvec, tvec, np.zeros(0)) for rvec, tvec in candidates(few, flat)]
    most = outlying(sights, np.full(1, np.inf))
    scores = [float(np.minimum(errors_of(sights, pose), most).sum()) for pose in drawn]
    return [drawn[index] for index in np.argsort(scores, kind="stable")[:4]]


def _grown(sights: Sights, start: Pose, ground: bool) -> Agreement | None:
    """Whoever agrees with the pose is fitted again, until nobody joins or leaves."""
    pose, agree = start, np.zeros(len(sights.points), dtype=bool)
    # A pose of five clicks is off by more than its clicks: the first turn forgives most.
    limit = outlying(sights, np.full(1, np.inf))
    for turn in range(ROUNDS):
        near = errors_of(sights, pose) <= limit
        if near.sum() < SUBSET or (turn > 1 and (near == agree).all()):
            break
        better = refined(sights.of(near), pose.rvec, pose.tvec)
        if better is None:
            return None
        pose, agree, limit = better, near, outlying(sights, better.errors)
    if agree.sum() < SUBSET or len(pose.errors) != agree.sum() or (ground and pose.centre[2] <= 0):
        return None
    return Agreement(pose, agree, limit)
