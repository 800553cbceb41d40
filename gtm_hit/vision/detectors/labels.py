"""Which labels of other people's detectors mean a person."""

from __future__ import annotations

PERSON = frozenset({"person", "people", "pedestrian", "human", "persons", "pedestrians"})


def is_person(label: str) -> bool:
    return label.strip().lower() in PERSON
