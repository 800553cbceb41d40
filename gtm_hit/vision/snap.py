"""Where somebody really stands whose place was marked roughly.

Places around the mark are scored by the detector's boxes and by what is not the background, as far as the
others who are marked do not explain them. The scores' peak, to less than a step, is where the person stands;
where the background says nothing, the edges of the boxes say to the centimetre where. Nobody is moved for a
small gain, far, or onto somebody else.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from gtm_hit.geometry.camera import Camera, Floats
from gtm_hit.vision.boxes import Box, as_array
from gtm_hit.vision.cover import CoverSettings, Match, matches_of
from gtm_hit.vision.fitting import fit
from gtm_hit.vision.masks import Masks
from gtm_hit.vision.outlines import Shown
from gtm_hit.vision.sights import Sight

MARKED = 0.5  # metres between a proposal and a mark of the same person
USUAL = CoverSettings().heights[0][0]  # metres: of whoever has no height of their own


class Refused(StrEnum):
    NOTHING = "nothing"  # no view supports anybody there
    SMALL = "small"  # it is about as good where it is
    NEAR = "near"  # somebody else stands there


@dataclass(frozen=True)
class SnapSettings:
    reach: float = 0.5  # metres: nobody is moved further
    step: float = 0.05  # metres between places that are scored
    sharp: float = 0.05  # of the scores: by how much better a place is e times as likely
    shown: float = 0.01  # what the logarithm of the foreground's likelihood counts for the scores
    least: float = 0.3  # a place must be worth this much
    gain: float = 0.05  # and so much more than the one marked
    apart: float = 0.35  # metres from everybody else
    cover: CoverSettings = field(default_factory=CoverSettings)


@dataclass(frozen=True, eq=False)
class Marks:
    """Who is marked in a frame: the one to be moved, and all others."""

    one: Floats  # (3,) x, y, height: metres
    others: Floats  # (N, 3)


def with_unmarked(marks: Marks, proposed: Floats) -> Marks:
    """Proposals (N, 3) explain the boxes of those who are not marked yet: else theirs would pull the one.

    They are of people who are neither marked nor the one meant, who is the one nearest to the mark.
    """
    free = _apart(proposed, marks.others) > MARKED
    off = np.hypot(*(proposed - marks.one)[:, :2].T)
    if free.any():
        free[np.flatnonzero(free)[off[free].argmin()]] = False
    return Marks(marks.one, np.vstack((marks.others, proposed[free])))


@dataclass(frozen=True)
class Snapped:
    x: float
    y: float
    gain: float
    refused: Refused | None = None


def snap(
    marks: Marks,
    boxes: Mapping[str, Sequence[Box]],
    cameras: Mapping[str, Camera],
    foregrounds: Masks | None = None,
    settings: SnapSettings | None = None,
) -> Snapped:
    """The better place, or the same one with the reason why it stays."""
    s = settings or SnapSettings()
    sights = {
        name: Sight(cameras[name], as_array(list(found)), s.cover.sight) for name, found in boxes.items()
    }
    taken = matches_of(sights, marks.others)
    places = _disc(marks.one, s)
    free = _apart(places, marks.others) >= s.apart
    scores = _Scores(sights, marks.others, taken)
    tried = np.vstack((places, marks.one))
    shown = s.shown * _shown(foregrounds or {}, cameras, tried, marks.others)
    worth = scores.of(tried) + shown
    if not free.any() or worth[:-1].max() < s.least:
        return _stays(marks, 0.0, Refused.NEAR if not free.any() else Refused.NOTHING)
    found = _peak(places[free], worth[:-1][free], s)
    gain = float(worth[:-1][free].max() - worth[-1])
    if not shown.any():
        found = _by_edges(marks, found, scores, cameras, s)
        gain = float(scores.of(found[None])[0] - worth[-1])
    if _apart(found[None], marks.others)[0] < s.apart:
        return _stays(marks, gain, Refused.NEAR)
    if gain < s.gain:
        return _stays(marks, gain, Refused.SMALL)
    return Snapped(float(found[0]), float(found[1]), gain)


def _stays(marks: Marks, gain: float, why: Refused) -> Snapped:
    return Snapped(float(marks.one[0]), float(marks.one[1]), gain, why)


def _disc(one: Floats, s: SnapSettings) -> Floats:
    """Bodies (N, 3) at all places within reach."""
    offsets = np.arange(-s.reach, s.reach + s.step / 2, s.step)
    around = np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 2)
    around = around[np.hypot(*around.T) <= s.reach]
    return np.column_stack((one[:2] + around, np.full(len(around), one[2])))


def _apart(bodies: Floats, others: Floats) -> Floats:
    """Metres from each to the nearest of the others."""
    away = bodies[:, None, :2] - others[None, :, :2]
    nearest: Floats = np.hypot(away[..., 0], away[..., 1]).min(axis=1, initial=np.inf)
    return nearest


def _peak(places: Floats, worth: Floats, s: SnapSettings) -> Floats:
    """The middle of what is about as good as the best, around it: other peaks do not pull."""
    best = places[worth.argmax()]
    weight = np.exp((worth - worth.max()) / s.sharp)
    weight[np.hypot(*(places[:, :2] - best[:2]).T) > s.reach / 2] = 0.0
    middle: Floats = (places * weight[:, None]).sum(axis=0) / weight.sum()
    return middle


def _shown(foregrounds: Masks, cameras: Mapping[str, Camera], bodies: Floats, others: Floats) -> Floats:
    """What is not the background says about bodies (N, 3), all views together, (N,)."""
    seen = (Shown(mask, cameras[name], others).agreement(bodies) for name, mask in foregrounds.items())
    return sum(seen, np.zeros(len(bodies)))


class _Scores:
    """What views say about bodies while others are there, whose boxes count by what they are worth more."""

    def __init__(self, sights: Mapping[str, Sight], others: Floats, taken: Sequence[Match]) -> None:
        self.sights, self._others = sights, others
        self._explained = {name: _explained(name, sight, others, taken) for name, sight in sights.items()}

    def of(self, bodies: Floats) -> Floats:
        total = np.zeros(len(bodies))
        for name, sight in self.sights.items():
            expected = sight.expected(bodies)
            best = (sight.worths(expected) - self._explained[name]).max(axis=1, initial=0.0)
            hidden = sight.hidden(bodies, expected, self._others)
            total += np.where(best > 0, best, np.where(hidden, 0.0, sight.missed(expected)))
        return total

    def box(self, name: str, body: Floats) -> int | None:
        """The box of a body in a view."""
        sight = self.sights[name]
        rest = (sight.worths(sight.expected(body[None])) - self._explained[name])[0]
        return int(rest.argmax()) if rest.max(initial=0.0) > 0 else None


def _explained(name: str, sight: Sight, others: Floats, taken: Sequence[Match]) -> Floats:
    """How much of each box is explained by the one of the others whose it is, (boxes,)."""
    explained = np.zeros(len(sight.found))
    worths = sight.worths(sight.expected(others))
    for other, match in enumerate(taken):
        if name in match:
            explained[match[name]] = worths[other, match[name]]
    return explained


def _by_edges(
    marks: Marks, peak: Floats, scores: _Scores, cameras: Mapping[str, Camera], s: SnapSettings
) -> Floats:
    """The body at the peak put where its boxes' edges say."""
    rows = {}
    for name, sight in scores.sights.items():
        box = scores.box(name, peak)
        rows[name] = np.full((1, 4), np.nan) if box is None else sight.found[box : box + 1, :4]
    bodies, _spread = fit(peak[None], peak[2:], rows, cameras, s.cover.fit)
    away = bodies[0, :2] - marks.one[:2]
    held = away * min(1.0, s.reach / max(float(np.hypot(*away)), 1e-9))
    return np.array([*(marks.one[:2] + held), marks.one[2]])
