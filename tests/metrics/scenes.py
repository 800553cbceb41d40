"""Scenes made by formula, so that numbers recorded from other programs stay comparable."""

from __future__ import annotations

import numpy as np

from gtm_hit.metrics.annotations import Annotations, Floats, Ids
from gtm_hit.metrics.matching import match_places


def crossing_people(
    people: int = 8, frames: int = 40, wobble: float = 0.2, swap_every: int = 13
) -> tuple[Annotations, Annotations]:
    """People on crossing curves, and somebody's imperfect annotations of them.

    Every seventh person-frame is missing, every eleventh is 0.7 m off, and identities rotate by one
    every `swap_every` frames.
    """
    frame, person = (values.ravel() for values in np.mgrid[0:frames, 0:people])
    angle = 0.13 * frame + 0.9 * person
    truth = np.column_stack((2.0 * np.sin(angle) + 0.2 * person, 2.0 * np.cos(0.7 * angle)))
    offset = wobble * np.column_stack((np.sin(17.0 * angle), np.cos(23.0 * angle)))
    count = np.arange(len(frame))
    offset[count % 11 == 5] += (0.7, 0.0)
    renamed = (person + frame // swap_every) % people + 100
    kept = count % 7 != 3
    return (
        Annotations(frame * 5, truth, person),
        Annotations(frame[kept] * 5, (truth + offset)[kept], renamed[kept]),
    )


def imperfect(
    people: Annotations,
    rng: np.random.Generator,
    missed: float = 0.08,
    invented: float = 0.05,
    swaps: int = 5,
    noise: float = 0.08,
    bias: tuple[float, float] = (0.04, -0.02),
) -> Annotations:
    """Everybody a little off and to one side, some missed, some invented, some who go on as somebody else.

    Shares of the annotations, and metres.
    """
    persons = people.identities().copy()
    frames = np.unique(people.frames)
    for frame in rng.choice(frames[1:], swaps, replace=False):
        one, other = rng.choice(np.unique(persons[people.frames == frame]), 2, replace=False)
        later = people.frames >= frame
        mine, theirs = later & (persons == one), later & (persons == other)
        persons[mine], persons[theirs] = other, one
    kept = rng.random(len(people)) >= missed
    xy = people.xy + bias + rng.normal(0.0, noise, people.xy.shape)
    extra = np.flatnonzero(rng.random(len(people)) < invented)
    low, high = people.xy.min(axis=0), people.xy.max(axis=0)
    return Annotations(
        np.concatenate((people.frames[kept], people.frames[extra])),
        np.concatenate((xy[kept], rng.uniform(low, high, (len(extra), 2)))),
        np.concatenate((persons[kept], persons.max() + 1 + np.arange(len(extra)))),
    )


def linked(frames: Ids, xy: Floats, reach: float = 1.5) -> Annotations:
    """Identities for places that have none: whoever is nearest in the frame before, within `reach` metres."""
    persons = np.full(len(frames), -1)
    before = np.zeros(0, dtype=int)
    count = 0
    for frame in np.unique(frames):
        rows = np.flatnonzero(frames == frame)
        earlier, later, _ = match_places(xy[before], xy[rows], reach)
        persons[rows[later]] = persons[before[earlier]]
        new = rows[persons[rows] < 0]
        persons[new] = count + np.arange(len(new))
        count += len(new)
        before = rows
    return Annotations(frames, xy, persons)
