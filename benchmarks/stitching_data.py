"""People with known identities for the stitching benchmark, and workers who annotate them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gtm_hit.demo.scene import read_scene
from gtm_hit.demo.walks import make_walks
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.stitching.tracks import Batch, Ids, Track, batch

FRAMES = 400
BATCH = 10
DEMO_SECONDS, FILE_SECONDS = 0.5, 0.4


@dataclass(frozen=True, eq=False)
class Truth:
    people: Annotations  # frames counted from 0
    seconds: float  # between frames


@dataclass(frozen=True)
class Workers:
    noise: float = 0.05  # metres, standard deviation in X and in Y
    missed: float = 0.03  # of all people
    extra: float = 0.01  # likewise


@dataclass(frozen=True, eq=False)
class Worked:
    """One worker's batch, and who its people are: -1 for somebody who is not there."""

    batch: Batch
    who: dict[tuple[int, int], int]  # by source


def demo(seed: int, frames: int = FRAMES) -> Truth:
    """The demo scene's crowd, walking on."""
    scene = replace(read_scene(), frame_count=frames)
    walks = make_walks(scene, np.random.default_rng((scene.seed, seed)))
    frame, person = np.nonzero(walks.present)
    return Truth(Annotations(frame, walks.xy[frame, person], person), DEMO_SECONDS)


def read(path: Path) -> Truth:
    """A file of `frame person x y`, metres; its frames step by one number throughout."""
    table = np.loadtxt(path, ndmin=2)
    numbers = np.round(table[:, 0]).astype(np.int64)
    step = int(np.diff(np.unique(numbers)).min())
    frames = (numbers - numbers.min()) // step
    _, first = np.unique(np.column_stack((frames, table[:, 1])), axis=0, return_index=True)
    people = Annotations(frames, table[:, 2:4], np.round(table[:, 1]).astype(np.int64))
    return Truth(people.take(first) if len(first) < len(frames) else people, FILE_SECONDS)


def spans(truth: Truth, overlap: int) -> list[Ids]:
    """Frames of batch after batch; each has the next one's first `overlap` frames too."""
    count = int(truth.people.frames.max()) + 1
    return [np.arange(at, min(at + BATCH + overlap, count)) for at in range(0, count - overlap, BATCH)]


def annotate(truth: Truth, covered: Ids, layer: int, rng: np.random.Generator, workers: Workers) -> Worked:
    """A batch as somebody annotates it who numbers people in an order of his own."""
    people = truth.people
    rows = np.flatnonzero((people.frames >= covered[0]) & (people.frames <= covered[-1]))
    rows = rows[rng.random(len(rows)) >= workers.missed]
    persons = people.identities()[rows]
    there = np.unique(persons)
    extra = rng.binomial(max(len(rows), 1), workers.extra)
    number = rng.permutation(len(there) + extra) + 1
    low, high = people.xy.min(axis=0), people.xy.max(axis=0)
    frames = np.concatenate((people.frames[rows], rng.choice(covered, extra)))
    xy = people.xy[rows] + rng.normal(0.0, workers.noise, (len(rows), 2))
    xy = np.concatenate((xy, rng.uniform(low, high, (extra, 2))))
    names = np.concatenate((number[np.searchsorted(there, persons)], number[len(there) :]))
    who = {(layer, int(name)): int(person) for name, person in zip(number, there, strict=False)}
    who |= {(layer, int(name)): -1 for name in number[len(there) :]}
    return Worked(batch(layer, covered.tolist(), frames, names, xy), who)


def parted(truth: Truth, gap: int, tracks: Sequence[tuple[int, Track]]) -> Annotations:
    """The truth in which somebody who was away for more than `gap` frames is somebody new.

    tracks : of persons; where one goes on over such a time its worker saw that it is the same person
    """
    people = truth.people
    order = np.lexsort((people.frames, people.identities()))
    frames, persons = people.frames[order], people.identities()[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (persons[1:] != persons[:-1]) | (np.diff(frames) > gap + 1)
    for person, track in tracks:
        start, end = np.searchsorted(persons, (person, person + 1))
        inside = start + np.flatnonzero((frames[start:end] > track.first) & (frames[start:end] <= track.last))
        new[inside[persons[inside - 1] == person]] = False
    return Annotations(frames, people.xy[order], np.cumsum(new))


def moved(made: Batch, frames: int) -> Batch:
    """The same batch later."""
    tracks = tuple(replace(track, frames=track.frames + frames) for track in made.tracks)
    return Batch(made.frames + frames, tracks)
