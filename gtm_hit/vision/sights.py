"""What one view says about bodies: which of its boxes they agree with, whether they are hidden or missing."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, Floats
from gtm_hit.vision.bodies import BodyBoxes, body_boxes

Worths = NDArray[np.float32]
Flags = NDArray[np.bool_]

UNSURE = 0.35  # a detector's score that counts nothing
NEARER = 0.1  # metres by which whoever hides somebody must be nearer to the camera


@dataclass(frozen=True)
class SightSettings:
    lowest: float = 0.40  # a detector's scores below are not looked at
    sure: float = 0.75  # a detector's score that counts fully
    radius: float = 0.20  # metres, of a body in a detector's eyes
    aside: float = 0.04  # how far boxes are off, as a share of their height: the middle,
    bottom: float = 0.06  # the feet
    top: float = 0.06  # and the head
    cap: float = 6.0  # a cut edge, of hidden legs, counts no more than so many squares
    most: float = 10.0  # squares at which a box no longer agrees at all
    missing: float = 0.10  # what a body loses where it should be seen and nothing is boxed
    hidden: float = 0.5  # share of a box behind somebody else from which nothing is missed


class Sight:
    """One view of one frame."""

    def __init__(self, camera: Camera, found: Floats, settings: SightSettings) -> None:
        self.camera, self.found, self.settings = camera, found, settings
        value = np.clip((found[:, 4] - UNSURE) / (settings.sure - UNSURE), 0, 1)
        self.value: Floats = np.where(found[:, 4] >= settings.lowest, value, 0.0)

    def expected(self, bodies: Floats) -> BodyBoxes:
        """Of bodies (N, 3): x, y, height."""
        return body_boxes(self.camera, bodies[:, :2], self.settings.radius, bodies[:, 2])

    def worths(self, expected: BodyBoxes) -> Worths:
        """What each box is worth to each body, (N, boxes); 0 where they have nothing in common."""
        worth = np.zeros((len(expected.share), len(self.found)), np.float32)
        middle = (expected.boxes[:, 0] + expected.boxes[:, 2]) / 2
        tall = expected.whole[:, 3] - expected.whole[:, 1]
        reach = self.settings.aside * np.sqrt(self.settings.most) * tall
        weight = np.sqrt(expected.share)
        counted = np.flatnonzero(self.value)
        middles = (self.found[counted, 0] + self.found[counted, 2]) / 2
        near = np.abs(middle[:, None] - middles) < reach[:, None]  # NaN is near nothing
        rows, columns = np.nonzero(near & (expected.share > 0)[:, None])
        boxes = counted[columns]
        agree = self._agreement(expected.boxes[rows], tall[rows], self.found[boxes])
        worth[rows, boxes] = agree * self.value[boxes] * weight[rows]
        return worth

    def _agreement(self, expected: Floats, tall: Floats, found: Floats) -> Floats:
        """How well boxes found (N, 4+) fit those expected (N, 4), 0…1."""
        s = self.settings
        aside = (found[:, 0] + found[:, 2] - expected[:, 0] - expected[:, 2]) / 2 / tall / s.aside
        bottom = (found[:, 3] - expected[:, 3]) / tall / s.bottom
        top = (found[:, 1] - expected[:, 1]) / tall / s.top
        off = aside**2 + np.minimum(bottom**2, s.cap) + np.minimum(top**2, s.cap)
        agree: Floats = np.clip(1 - off / s.most, 0, 1)
        return agree

    def missed(self, expected: BodyBoxes) -> Floats:
        """What bodies (N,) lose when no box is theirs."""
        return -self.settings.missing * np.sqrt(expected.share)

    def hidden(self, bodies: Floats, expected: BodyBoxes, others: Floats) -> Flags:
        """Which of the bodies (N, 3) are mostly behind one of the others (M, 3)."""
        hidden = np.zeros(len(bodies), bool)
        away = self._away(bodies)
        area = np.prod(expected.boxes[:, 2:] - expected.boxes[:, :2], axis=1)
        front = self.expected(others)
        for box, share, near in zip(front.boxes, front.share, self._away(others), strict=True):
            if share > 0:
                low = np.maximum(expected.boxes[:, :2], box[:2])
                high = np.minimum(expected.boxes[:, 2:], box[2:])
                common = np.prod(np.maximum(high - low, 0), axis=1)
                hidden |= (away > near + NEARER) & (common > self.settings.hidden * area)
        return hidden

    def _away(self, bodies: Floats) -> Floats:
        away: Floats = np.hypot(*(bodies[:, :2] - self.camera.centre[:2]).T)
        return away


class Candidates:
    """Bodies that may be taken, as one view judges them while more and more of its boxes are used."""

    def __init__(self, sight: Sight, bodies: Floats, expected: BodyBoxes, worth: Worths) -> None:
        self.sight, self.bodies, self.expected, self.worth = sight, bodies, expected, worth
        self.missed = sight.missed(expected)
        self.hidden: Flags = np.zeros(len(bodies), bool)
        self.used: frozenset[int] = frozenset()
        self.best = worth.max(axis=1, initial=0)

    def total(self) -> Floats:
        return np.where(self.best > 0, self.best, np.where(self.hidden, 0.0, self.missed))

    def use(self, boxes: Iterable[int]) -> None:
        used = frozenset(boxes)
        changed = sorted(used ^ self.used)
        self.used = used
        if changed:
            rows = np.flatnonzero((self.worth[:, changed] > 0).any(axis=1))
            free = np.delete(self.worth[rows], sorted(used), axis=1)
            self.best[rows] = free.max(axis=1, initial=0)

    def hide(self, others: Floats) -> None:
        """Candidates behind others (M, 3) are missed no longer."""
        self.hidden |= self.sight.hidden(self.bodies, self.expected, others)
