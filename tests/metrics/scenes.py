"""Scenes made by formula, so that numbers recorded from other programs stay comparable."""

from __future__ import annotations

import numpy as np

from gtm_hit.metrics.annotations import Annotations


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
