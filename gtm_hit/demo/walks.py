"""Where everybody of the demo scene is in every frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from gtm_hit.demo.arrays import Flags, Floats
from gtm_hit.demo.scene import Area, Scene, SceneError

TICK = 0.1  # seconds between the instants at which distances are checked
ELBOW_ROOM = 0.85  # metres between people who do not walk together
ATTEMPTS = 4000
OUTSKIRTS = 3.2  # metres beyond the grid that people may walk on
KERB = 0.35  # metres kept to the grid's border by those who stay on it
PAIR_GAP = (0.56, 0.7)  # metres between two who walk together
END = 0.12  # share of the grid's length at each end in which people enter and leave
LEG = 100  # ticks that are planned at once
LEG_ATTEMPTS = 60
SPEEDS = (0.88, 1.5)  # metres per second


@dataclass(frozen=True)
class Walks:
    """P people in F frames; everything a body needs to be posed."""

    xy: Floats  # (F, P, 2) metres, the ground point midway between the feet
    heading: Floats  # (F, P) radians from X towards Y
    phase: Floats  # (F, P) radians of the gait, 2π per two steps
    speed: Floats  # (P,) metres per second, 0 for those who stand
    height: Floats  # (P,) metres
    build: Floats  # (P,) girth relative to the average
    gaze: Floats  # (P,) radians the head is turned to the left of the heading
    present: Flags  # (F, P) on the grid

    @property
    def people(self) -> int:
        return self.xy.shape[1]


@dataclass(frozen=True)
class _Track:
    """One person's way, a point per tick."""

    xy: Floats  # (T, 2)
    heading: Floats  # (T,)
    speed: float
    gaze: float

    def beside(self, gap: float, gaze: float) -> _Track:
        left = np.stack((-np.sin(self.heading), np.cos(self.heading)), axis=1)
        return _Track(self.xy + gap * left, self.heading, self.speed, gaze)


def make_walks(scene: Scene, rng: np.random.Generator) -> Walks:
    """Smooth paths on which nobody comes closer than 0.45 m to anybody.

    Raises SceneError when the crowd of the description finds no room.
    """
    planner = _Planner(scene, rng)
    crowd = scene.crowd
    for size in crowd.standing_groups:
        planner.add(partial(planner.circle, size))
    for _ in range(crowd.standing_alone):
        planner.add(partial(planner.circle, 1))
    for _ in range(crowd.pairs):
        planner.add(planner.pair)
    for index in range(crowd.walkers):
        planner.add(planner.crossing if index < crowd.crossing else planner.single)
    return _sampled(scene, planner, rng)


class _Planner:
    """Proposes tracks at random and keeps those with room around them."""

    def __init__(self, scene: Scene, rng: np.random.Generator) -> None:
        self.scene, self.rng = scene, rng
        seconds = scene.frame_numbers[-1] / scene.numbers_per_second
        # Short scenes are the beginning of a longer one, in which there is time to enter and to leave.
        self.times = np.arange(max(round(seconds / TICK) + 1, LEG)) * TICK  # seconds
        self.tracks: list[_Track] = []
        grid = scene.grid
        width, length = grid.extent
        east, north = grid.origin_x + width, grid.origin_y + length
        self.grid_area = Area(grid.origin_x, east - grid.step, grid.origin_y, north - grid.step)
        self.walkable = Area(grid.origin_x + KERB, east - KERB, grid.origin_y - OUTSKIRTS, north + OUTSKIRTS)
        self.inner = Area(grid.origin_x + KERB, east - KERB, grid.origin_y + KERB, north - KERB)

    def add(self, propose: Callable[[], list[_Track]]) -> None:
        for _ in range(ATTEMPTS):
            tracks = propose()
            if tracks and self._has_room(tracks):
                self.tracks.extend(tracks)
                return
        raise SceneError(f"no room for {len(self.tracks) + 1} people after {ATTEMPTS} attempts")

    def single(self) -> list[_Track]:
        through = self._point(self.scene.crowd.core)
        return self._walk(self._leg(through), self.inner)

    def crossing(self) -> list[_Track]:
        """One who is on the grid in some frames and beyond one of its far ends in others."""
        inner, depth = self.inner, END * (self.inner.north - self.inner.south)
        south = Area(inner.west, inner.east, inner.south, inner.south + depth)
        north = Area(inner.west, inner.east, inner.north - depth, inner.north)
        leg = self._leg(self._point(south if self.rng.random() < 0.5 else north))
        both = 0.3 < self.grid_area.contains(leg.xy).mean() < 0.9
        return self._walk(leg, self.walkable) if both else []

    def pair(self) -> list[_Track]:
        gap, turn = self.rng.uniform(*PAIR_GAP), self.rng.uniform(0.25, 0.6)
        found = self._walk(self._leg(self._point(self.scene.crowd.core)), self.inner, gap)
        return [replace(found[0], gaze=turn * 0.8), found[0].beside(gap, -turn)] if found else []

    def circle(self, size: int) -> list[_Track]:
        """People who stand and face each other, or one alone."""
        middle, turn = self._point(self.scene.crowd.core), self.rng.uniform(0, 2 * np.pi)
        radius = 0.0 if size == 1 else self.rng.uniform(0.42, 0.5) / np.sin(np.pi / size)
        angles = turn + np.arange(size) * 2 * np.pi / size + self.rng.uniform(-0.15, 0.15, size)
        spots = middle + radius * np.stack((np.cos(angles), np.sin(angles)), axis=1)
        still = np.ones(len(self.times))
        return [
            _Track(still[:, None] * spot, still * (angle + np.pi), 0.0, self.rng.uniform(-0.35, 0.35))
            for spot, angle in zip(spots, angles, strict=True)
        ]

    def _leg(self, through: Floats) -> _Track:
        """Constant speed along a gently swaying heading, through a point some time."""
        times = self.times[:LEG]
        speed = self.rng.uniform(*SPEEDS)
        along = self.rng.choice((-1, 1)) * np.pi / 2
        sway, pace, start = self.rng.uniform(0.05, 0.3), self.rng.uniform(0.25, 0.6), self.rng.uniform(0, 6.3)
        heading = along + self.rng.normal(0, 0.65) + sway * np.sin(pace * times + start)
        xy = _strides(heading, speed).cumsum(axis=0)
        xy += through - xy[self.rng.integers(len(times) // 4, 1 + 3 * len(times) // 4)]
        return _Track(xy, heading, speed, self.rng.normal(0, 0.25))

    def _walk(self, leg: _Track, area: Area, gap: float | None = None) -> list[_Track]:
        """A first leg and as many more as the scene lasts; empty if there is no room for them."""
        legs, xy, heading = [0], leg.xy, leg.heading
        if not self._free(leg, 0, area, gap):
            return []
        for _ in range(LEG_ATTEMPTS * len(self.times) // LEG):
            if len(xy) >= len(self.times):
                break
            more = self._turn(xy[-1], heading[-1], leg.speed, self._point(area))
            if self._free(more, len(xy), area, gap):
                legs.append(len(xy))
                xy, heading = np.concatenate((xy, more.xy)), np.concatenate((heading, more.heading))
            elif self.rng.random() < 2 / LEG_ATTEMPTS and len(legs) > 1:
                xy, heading = xy[: legs[-1]], heading[: legs.pop()]  # a dead end: go back and turn elsewhere
        ticks = len(self.times)
        return [_Track(xy[:ticks], heading[:ticks], leg.speed, leg.gaze)] if len(xy) >= ticks else []

    def _turn(self, start: Floats, heading: float, speed: float, target: Floats) -> _Track:
        """A leg that bends towards a target and goes on past it."""
        towards = np.arctan2(*(target - start)[::-1])
        bend = np.mod(towards - heading + np.pi, 2 * np.pi) - np.pi
        share = np.clip(np.arange(1, LEG + 1) * TICK / (1 + 1.6 * abs(bend)), 0, 1)
        headings = heading + bend * share**2 * (3 - 2 * share)
        return _Track(start + _strides(headings, speed).cumsum(axis=0), headings, speed, 0.0)

    def _free(self, leg: _Track, first: int, area: Area, gap: float | None) -> bool:
        """Whether a leg from this tick on, and the partner's, stays in the area and away from everybody."""
        tracks = [leg] if gap is None else [leg, leg.beside(gap, 0.0)]
        return all(area.contains(track.xy).all() for track in tracks) and self._has_room(tracks, first)

    def _point(self, area: Area) -> Floats:
        return np.array([self.rng.uniform(area.west, area.east), self.rng.uniform(area.south, area.north)])

    def _has_room(self, tracks: list[_Track], first: int = 0) -> bool:
        ticks = slice(first, first + len(tracks[0].xy))
        for track in tracks:
            for x, y, radius in self.scene.crowd.keep_clear:
                if np.hypot(track.xy[:, 0] - x, track.xy[:, 1] - y).min() < radius:
                    return False
            for other in self.tracks:
                passing = other.xy[ticks]
                if np.linalg.norm(track.xy[: len(passing)] - passing, axis=1).min(initial=9) < ELBOW_ROOM:
                    return False
        return True


def _strides(heading: Floats, speed: float) -> Floats:
    return speed * TICK * np.stack((np.cos(heading), np.sin(heading)), axis=1)


def _sampled(scene: Scene, planner: _Planner, rng: np.random.Generator) -> Walks:
    tracks = planner.tracks
    ticks = np.round(np.array(scene.frame_numbers) / scene.numbers_per_second / TICK).astype(int)
    xy = np.stack([track.xy for track in tracks], axis=1)
    height = np.clip(rng.normal(1.73, 0.09, len(tracks)), 1.5, 1.95)
    speed = np.array([track.speed for track in tracks])
    stride = 1.36 * (height / 1.75) * np.sqrt(np.maximum(speed, 0.1) / 1.3)  # metres per two steps
    travelled = np.concatenate(
        (np.zeros((1, len(tracks))), np.linalg.norm(np.diff(xy, axis=0), axis=2).cumsum(axis=0))
    )
    phase = rng.uniform(0, 2 * np.pi, len(tracks)) + 2 * np.pi * travelled / stride
    return Walks(
        xy=xy[ticks],
        heading=np.stack([track.heading for track in tracks], axis=1)[ticks],
        phase=phase[ticks],
        speed=speed,
        height=height,
        build=np.clip(rng.normal(1.0, 0.09, len(tracks)), 0.84, 1.25),
        gaze=np.array([track.gaze for track in tracks]),
        present=planner.grid_area.contains(xy[ticks]),
    )
