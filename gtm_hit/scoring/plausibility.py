"""What the workbench warns of, counted on the server: two people in one place, and people who are too fast.

The rules of static/truth/plausibility.js, without the one that needs to know what the cameras see.
"""

from __future__ import annotations

import numpy as np

from gtm_hit.metrics.annotations import Annotations
from gtm_hit.metrics.matching import distances_between

NEAREST = 0.3  # metres; two bodies do not fit closer
FASTEST = 3.0  # m/s


def count_warnings(people: Annotations, seconds_per_number: float) -> int:
    """`seconds_per_number`: time between two frame numbers."""
    numbers = np.unique(people.frames)
    close = sum(_too_close(people, number) for number in numbers.tolist())
    pairs = zip(numbers[:-1].tolist(), numbers[1:].tolist(), strict=True)
    return close + sum(_too_fast(people, one, other, seconds_per_number) for one, other in pairs)


def _too_close(people: Annotations, number: int) -> int:
    places = people.xy[people.frames == number]
    apart = distances_between(places, places)
    return int((np.triu(apart < NEAREST, 1)).sum())


def _too_fast(people: Annotations, number: int, following: int, seconds_per_number: float) -> int:
    before, after = (np.flatnonzero(people.frames == one) for one in (number, following))
    persons = people.identities()
    _same, first, second = np.intersect1d(persons[before], persons[after], return_indices=True)
    way = np.hypot(*(people.xy[after[second]] - people.xy[before[first]]).T)
    return int((way > FASTEST * (following - number) * seconds_per_number).sum())
