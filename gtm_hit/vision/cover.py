"""Boxes of all views become people on the ground: the fewest bodies that explain them, found greedily.

A body standing somewhere is expected to fill a box in every view. It is worth as much as the detector's boxes
it agrees with; each box counts for one body only. The best body is taken, its boxes are used up, and so on
until nobody is worth enough; then all are fitted to their boxes, whoever is worth too little with all the
others in place goes, and what became free is tried again. Feet are never projected on their own: half of them
are hidden. Smaller bodies, of children and of those who sit, are tried with what is left over.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import linear_sum_assignment

from gtm_hit.geometry.camera import Camera, Floats
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.bodies import BodyBoxes, body_boxes
from gtm_hit.vision.boxes import Box, as_array
from gtm_hit.vision.fitting import FitSettings, chosen_boxes, fit
from gtm_hit.vision.sights import Candidates, Flags, Sight, SightSettings

Match = dict[str, int]  # a body's box in each view that has one


@dataclass(frozen=True)
class CoverSettings:
    enough: float = 0.6  # a body must be worth this much
    apart: float = 0.35  # metres between two bodies
    step: float = 0.15  # metres between places that are tried
    margin: float = 2.0  # metres around the grid in which people may explain boxes
    rounds: int = 2
    # Standing, children, sitting: heights that are tried, and in how many views each must be boxed.
    heights: tuple[tuple[float, int], ...] = ((1.72, 1), (1.25, 2), (0.9, 2))
    sitting: float = 1.05  # metres: who is shorter sits
    better: float = 0.15  # another height must be worth so much more
    sight: SightSettings = field(default_factory=SightSettings)
    fit: FitSettings = field(default_factory=FitSettings)


@dataclass(frozen=True, eq=False)
class Body:
    xy: Floats  # (2,) metres
    height: float  # metres
    worth: float
    boxes: Match
    spread: Floats  # (2, 2) square metres: the covariance of the place


class Places:
    """The places that are tried and the boxes expected there; made once for many frames."""

    def __init__(self, cameras: Mapping[str, Camera], grid: Grid, settings: CoverSettings) -> None:
        width, length = grid.extent
        xs = np.arange(-settings.margin, width + settings.margin, settings.step) + grid.origin_x
        ys = np.arange(-settings.margin, length + settings.margin, settings.step) + grid.origin_y
        xy = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
        self.passes: list[tuple[Floats, dict[str, BodyBoxes]]] = []
        for height, _ in settings.heights:
            seen = {
                name: body_boxes(camera, xy, settings.sight.radius, height)
                for name, camera in cameras.items()
            }
            self.passes.append((np.column_stack((xy, np.full(len(xy), height))), seen))


def cover(
    boxes: Mapping[str, Sequence[Box]],
    cameras: Mapping[str, Camera],
    places: Places,
    settings: CoverSettings,
) -> list[Body]:
    """Everybody found, in and around the area, best first."""
    search = _Search(boxes, cameras, settings)
    for kind, (bodies, expected) in enumerate(places.passes):
        candidates = search.candidates(bodies, expected)
        for _ in range(settings.rounds):
            search.take(candidates, kind)
            search.settle()
    return search.people()


class _Search:
    def __init__(
        self, boxes: Mapping[str, Sequence[Box]], cameras: Mapping[str, Camera], settings: CoverSettings
    ) -> None:
        self.settings = settings
        self.boxes = boxes
        self.cameras = cameras
        self.sights = {
            name: Sight(cameras[name], as_array(list(found)), settings.sight) for name, found in boxes.items()
        }
        self.taken: Floats = np.zeros((0, 3))  # x, y, height
        self.kinds = np.zeros(0, np.int64)  # which of the settings' heights
        self.usual = np.array([height for height, _ in settings.heights])
        self.least = np.array([views for _, views in settings.heights])
        self.spread: Floats = np.zeros((0, 2, 2))

    def candidates(self, bodies: Floats, expected: Mapping[str, BodyBoxes]) -> dict[str, Candidates]:
        """Those of the bodies that could be worth enough at all."""
        worths = {name: sight.worths(expected[name]) for name, sight in self.sights.items()}
        hoped = sum((worth.max(axis=1, initial=0) for worth in worths.values()), np.zeros(len(bodies)))
        rows = np.flatnonzero(hoped >= self.settings.enough)
        return {
            name: Candidates(sight, bodies[rows], expected[name].rows(rows), worths[name][rows])
            for name, sight in self.sights.items()
        }

    def take(self, candidates: Mapping[str, Candidates], kind: int) -> None:
        """One body after the other, the best first, until none is worth enough."""
        self._tell(candidates, self.taken)
        bodies = next(iter(candidates.values())).bodies if candidates else self.taken
        free: Flags = self._is_free(bodies[:, :2])
        while free.any():
            total = sum((each.total() for each in candidates.values()), np.zeros(len(bodies)))
            boxed = sum((each.best > 0 for each in candidates.values()), np.zeros(len(bodies), int))
            total[~free | (boxed < self.least[kind])] = -np.inf
            best = int(total.argmax())
            if total[best] < self.settings.enough:
                return
            self._append(bodies[best], kind)
            self._tell(candidates, bodies[best : best + 1])
            free = free & self._is_free(bodies[:, :2])

    def _append(self, body: Floats, kind: int) -> None:
        self.taken = np.vstack((self.taken, body))
        self.spread = np.concatenate((self.spread, np.eye(2)[None]))
        self.kinds = np.append(self.kinds, kind)

    def _tell(self, candidates: Mapping[str, Candidates], new: Floats) -> None:
        matches = self._matches()
        for name, each in candidates.items():
            each.use(match[name] for match in matches if name in match)
            each.hide(new)

    def _is_free(self, xy: Floats) -> Flags:
        away = xy[:, None] - self.taken[None, :, :2]
        return np.asarray((np.hypot(away[..., 0], away[..., 1]) >= self.settings.apart).all(axis=1))

    def _matches(self) -> list[Match]:
        return matches_of(self.sights, self.taken)

    def settle(self) -> None:
        """Fit all to their boxes; let go, worst first, who then is not worth enough."""
        if len(self.taken):
            self._choose_kinds()
            found = chosen_boxes(self.boxes, self._matches())
            usual = self.usual[self.kinds]
            self.taken, self.spread = fit(self.taken, usual, found, self.cameras, self.settings.fit)
        while len(self.taken):
            matches = self._matches()
            worth = self.worth(matches)
            boxed = np.array([len(match) for match in matches])
            worth[boxed < self.least[self.kinds]] = -np.inf
            worth[self._too_close(worth)] = -np.inf
            worst = int(worth.argmin())
            if worth[worst] >= self.settings.enough:
                return
            self.taken = np.delete(self.taken, worst, axis=0)
            self.spread = np.delete(self.spread, worst, axis=0)
            self.kinds = np.delete(self.kinds, worst)

    def _choose_kinds(self) -> None:
        """Whoever fits their own boxes clearly better as a child or sitting becomes that."""
        matches = self._matches()
        now = self._agreed(self.taken, matches)
        for kind, height in enumerate(self.usual):
            other = self.taken.copy()
            other[:, 2] = height
            agreed = self._agreed(other, matches)
            better = (agreed > now + self.settings.better) & (self.kinds != kind)
            self.taken[better, 2], self.kinds[better] = height, kind
            now = np.where(better, agreed, now)

    def _agreed(self, bodies: Floats, matches: Sequence[Match]) -> Floats:
        """What their boxes are worth to bodies (N, 3)."""
        total = np.zeros(len(bodies))
        for name, sight in self.sights.items():
            worths = sight.worths(sight.expected(bodies))
            for body, match in enumerate(matches):
                if name in match:
                    total[body] += worths[body, match[name]]
        return total

    def _too_close(self, worth: Floats) -> list[int]:
        """The lesser of every two bodies that came too close."""
        away = self.taken[:, None, :2] - self.taken[None, :, :2]
        first, second = np.nonzero(np.triu(np.hypot(away[..., 0], away[..., 1]) < self.settings.apart, 1))
        pairs = zip(first.tolist(), second.tolist(), strict=True)
        return [one if worth[one] < worth[two] else two for one, two in pairs]

    def worth(self, matches: Sequence[Match]) -> Floats:
        total = np.zeros(len(self.taken))
        for name, sight in self.sights.items():
            expected = sight.expected(self.taken)
            worths, missed = sight.worths(expected), sight.missed(expected)
            hidden = sight.hidden(self.taken, expected, self.taken)
            for body, match in enumerate(matches):
                if name in match:
                    total[body] += worths[body, match[name]]
                elif not hidden[body]:
                    total[body] += missed[body]
        return total

    def people(self) -> list[Body]:
        matches = self._matches()
        rows = zip(self.taken, self.worth(matches).tolist(), matches, self.spread, strict=True)
        people = [Body(each[:2], float(each[2]), worth, boxes, spread) for each, worth, boxes, spread in rows]
        return sorted(people, key=lambda body: -body.worth)


def matches_of(sights: Mapping[str, Sight], bodies: Floats) -> list[Match]:
    """The boxes of each body: of every view the assignment that is worth most together."""
    matches: list[Match] = [{} for _ in bodies]
    for name, sight in sights.items():
        gain = sight.worths(sight.expected(bodies))
        for body, box in zip(*linear_sum_assignment(-gain), strict=True):
            if gain[body, box] > 0:
                matches[body][name] = int(box)
    return matches
