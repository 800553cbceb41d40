"""Several workers' annotations of the same frames into one: who is there, where, and who differs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from gtm_hit.stitching.merging import place_of
from gtm_hit.stitching.precision import variances
from gtm_hit.stitching.replicas import People, Point, same_people
from gtm_hit.stitching.rules import Rules
from gtm_hit.stitching.smoothing import smoothed
from gtm_hit.stitching.tracks import Batch, Track, in_order


@dataclass
class Disagreement:
    """How far one worker is from what all of them together say."""

    places: int = 0  # of his that went into the result
    distance: float = 0.0  # metres, the sum over them
    missed: int = 0  # people of the result he does not have
    extra: int = 0  # people only he has, or too few others
    renumbered: int = 0  # places the others have under another identity

    @property
    def mean_distance(self) -> float:
        return self.distance / self.places if self.places else float("nan")


@dataclass(frozen=True, eq=False)
class Fused:
    batch: Batch
    disagreements: list[Disagreement]  # one per replica, in the order given


@dataclass(eq=False)
class _Person:
    frames: list[int] = field(default_factory=list)
    places: list[np.ndarray] = field(default_factory=list)
    noise: list[float] = field(default_factory=list)
    points: list[list[Point]] = field(default_factory=list)


def fuse(replicas: Sequence[Batch], rules: Rules) -> Fused:
    """One batch out of several of the same frames; a single one stays as it is."""
    differing = [Disagreement() for _ in replicas]
    if len(replicas) == 1:
        differing[0].places = sum(len(track.frames) for track in replicas[0].tracks)
        return Fused(replicas[0], differing)
    people = same_people(replicas, rules.gate)
    spread = variances(people, len(replicas), rules.noise)
    covering = _covering(replicas)
    tracks = []
    for person in people:
        made = _elected(person, covering, spread, differing)
        if made.frames:
            tracks.append(_track(made, rules, differing))
    frames = np.array(sorted(covering), dtype=np.int64)
    return Fused(Batch(frames, in_order(tracks)), differing)


def _covering(replicas: Sequence[Batch]) -> dict[int, set[int]]:
    """By frame: the replicas whose workers looked at it."""
    covering: dict[int, set[int]] = {}
    for number, replica in enumerate(replicas):
        for frame in replica.frames.tolist():
            covering.setdefault(frame, set()).add(number)
    return covering


def _elected(
    person: People, covering: dict[int, set[int]], spread: np.ndarray, differing: list[Disagreement]
) -> _Person:
    """The frames in which at least half of those who looked have the person."""
    made = _Person()
    for frame in sorted(person):
        points = person[frame]
        looked = covering[frame]
        if 2 * len(points) < len(looked):
            for point in points:
                differing[point.replica].extra += 1
            continue
        weights = np.array([1 / spread[point.replica] for point in points])
        made.frames.append(frame)
        made.places.append(place_of(np.stack([point.xy for point in points]), weights))
        made.noise.append(float(1 / np.sqrt(weights.sum())))
        made.points.append(points)
        for missing in looked - {point.replica for point in points}:
            differing[missing].missed += 1
    return made


def _track(made: _Person, rules: Rules, differing: list[Disagreement]) -> Track:
    frames = np.array(made.frames, dtype=np.int64)
    places = smoothed(frames, np.stack(made.places), np.array(made.noise), rules.seconds)
    for place, points in zip(places, made.points, strict=True):
        for point in points:
            differing[point.replica].places += 1
            differing[point.replica].distance += float(np.hypot(*(point.xy - place)))
            differing[point.replica].renumbered += point.moved
    votes = tuple(tuple(sorted(point.source for point in points)) for points in made.points)
    sources = frozenset(point.source for points in made.points for point in points if not point.moved)
    return Track(sources or frozenset(votes[0]), frames, places, votes)
