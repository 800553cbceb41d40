"""One person of one frame, as operations hand it around, the database keeps it and answers show it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from operator import itemgetter
from typing import Any, Self

from gtm_hit.models import Annotation


@dataclass(frozen=True)
class Row:
    """The order of the fields is the order in which rows are stored and sent."""

    person: int
    position: int
    state: str = Annotation.State.VALIDATED.value
    origin: str = Annotation.Origin.CLICKED.value
    height: float | None = None  # metres; None: the dataset's cylinder
    radius: float | None = None

    @classmethod
    def carried(cls, person: int, position: int) -> Self:
        """Somebody taken over from another frame, whom nobody has looked at here."""
        return cls(person, position, Annotation.State.CARRIED.value, Annotation.Origin.CARRIED.value)

    @classmethod
    def from_dict(cls, kept: Mapping[str, Any]) -> Self:
        """PostgreSQL keeps the keys of JSON objects in an order of its own."""
        return cls(*_kept_values(kept))

    def as_dict(self) -> dict[str, Any]:
        return dict(vars(self))

    def values(self) -> tuple[Any, ...]:
        return tuple(vars(self).values())


FIELDS = tuple(field.name for field in fields(Row))

_kept_values = itemgetter(*FIELDS)
