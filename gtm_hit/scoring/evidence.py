"""What is counted in assignments. Counts add up: a worker's evidence is the sum over his assignments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Self


@dataclass(frozen=True)
class Evidence:
    # Against known truth.
    gold_frames: float = 0
    truth: float = 0  # people there
    found: float = 0  # people marked
    matched: float = 0
    placed: float = 0  # of the matched, near enough
    same: float = 0  # near pairs whose identities go together, IDF1's
    # Planted faults.
    faults: float = 0
    repaired: float = 0
    # Against others who did the same frames.
    shared: float = 0  # annotations of both sides
    agreed: float = 0  # of those, the ones the other has too
    # How the work was done.
    people: float = 0  # annotations in the end
    seconds: float = 0
    carried: float = 0  # annotations that began with somebody put there by a program
    untouched: float = 0  # of those, the ones that still stand where they were put
    edits: float = 0  # people changed by saves
    warnings: float = 0
    careless: float = 0  # 0 to 1 for every assignment: how much the way of working speaks against it
    finished: float = 0  # assignments
    dropped: float = 0  # assignments whose time ran out

    def __add__(self, other: Evidence) -> Evidence:
        return Evidence(
            **{one.name: getattr(self, one.name) + getattr(other, one.name) for one in fields(self)}
        )

    def as_dict(self) -> dict[str, float]:
        return dict(vars(self))

    @classmethod
    def from_dict(cls, kept: Mapping[str, Any]) -> Self:
        return cls(**{one.name: kept.get(one.name, 0) for one in fields(cls)})
