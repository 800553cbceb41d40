"""How many clicks it takes until all measured points are in a picture, once four of them are.

As on the desk's page *Ground*: after each click the pose is solved, and every other point is expected
somewhere. Where that is within a pixel of its place, it is confirmed (one key). Where its place is seen under
the magnifier, and nearer to where it is expected than to any other such place, it is clicked (one click).
Else it is chosen by its name before it is clicked (two).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from gtm_hit.calibration.ghosts import expected_pixels
from gtm_hit.calibration.ground_points import GroundPoint
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.pose import Pair, PoseError, PoseSolution, solve_pose

FIRST = 4
CONFIRMED = 1.0  # pixels
MAGNIFIED = 20.0  # pixels around the pointer that the page's magnifier shows
CSS_PIXEL = 2.0  # pixels of the picture: a full-HD picture, 960 wide on the screen
WANTED = 23  # pairs, of cameras that have more


@dataclass(frozen=True)
class Effort:
    """Of one camera, after the first four."""

    confirmed: int  # points that lay where they were expected
    clicked: int
    chosen: int  # points that had to be chosen by their names, too
    solution: PoseSolution

    @property
    def actions(self) -> int:
        return self.confirmed + self.clicked + 2 * self.chosen


def corners(pairs: Sequence[Pair]) -> list[Pair]:
    """The four that are farthest apart in the picture: those with the largest area between them."""
    pixels = np.array([pair.pixel for pair in pairs])
    fours = np.array(list(combinations(range(len(pairs)), FIRST)))
    # In whichever order the four stand around their area, one of the three is the largest.
    areas = [_area(pixels[fours[:, order]]) for order in ([0, 1, 2, 3], [0, 2, 1, 3], [0, 1, 3, 2])]
    return [pairs[place] for place in fours[int(np.argmax(np.max(areas, axis=0)))]]


def some_four(lens: Lens, pairs: Sequence[Pair], rng: np.random.Generator) -> list[Pair]:
    """Any four that give a pose."""
    while True:
        four = [pairs[place] for place in rng.choice(len(pairs), FIRST, replace=False)]
        try:
            solve_pose(lens, four)
        except PoseError:
            continue
        return four


def effort(lens: Lens, pairs: Sequence[Pair], first: Sequence[Pair]) -> Effort:
    """Points come in the order of the list, as the page offers them; up to `WANTED` of them."""
    done, counts = list(first), {"confirmed": 0, "clicked": 0, "chosen": 0}
    names = {pair.name for pair in first}
    left = [pair for pair in pairs if pair.name not in names][: WANTED - FIRST]
    solution = solve_pose(lens, done)
    while left:
        pair, how = _next(solution, left)
        left = [each for each in left if each.name != pair.name]
        counts[how] += 1
        done.append(pair)
        solution = solve_pose(lens, done)
    return Effort(**counts, solution=solution)


def _next(solution: PoseSolution, left: Sequence[Pair]) -> tuple[Pair, str]:
    """The next pair as it is put into the picture, and what that took."""
    ghosts = expected_pixels(solution, [GroundPoint(pair.name, *pair.point) for pair in left])
    expected = np.array([(each.x, each.y) if each.visible else (np.inf, np.inf) for each in ghosts])
    # Points that are expected come first; without one the next of the list is chosen by its name.
    place = next((place for place, ghost in enumerate(ghosts) if ghost.visible), 0)
    pair = left[place]
    away = np.hypot(*(expected - pair.pixel).T)
    if away[place] <= CONFIRMED:
        return replace(pair, pixel=(ghosts[place].x, ghosts[place].y)), "confirmed"
    x, y = (round(value / CSS_PIXEL) * CSS_PIXEL for value in pair.pixel)
    near = away[place] <= MAGNIFIED and away.argmin() == place
    return replace(pair, pixel=(x, y)), "clicked" if near else "chosen"


def _area(quads: np.ndarray) -> np.ndarray:
    x, y = quads[..., 0], quads[..., 1]
    return np.abs((x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1)) / 2
