"""Which boxes of a COCO file are people."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gtm_hit.formats.problems import ProblemList, shown

PERSON_NAMES = ("person", "pedestrian", "people", "human")
MOST_NAMED = 10


@dataclass(frozen=True)
class Categories:
    """Names by id, as text: some programs write ids of categories as texts and refer to them by numbers.

    Without any list of categories, `names` is None and every box is a person.
    """

    names: dict[str, str] | None

    @classmethod
    def of(cls, listed: Any) -> Categories:
        if not isinstance(listed, list):
            return cls(None)
        named = (each for each in listed if isinstance(each, dict))
        return cls({_key(each.get("id")): str(each.get("name")).strip() for each in named})

    def has_people(self, entry: dict[str, Any], place: str, problems: ProblemList) -> bool:
        """Whether a box is a person's; a box whose category cannot tell is a problem."""
        if self.names is None:
            return True
        if not any(name.lower() in PERSON_NAMES for name in self.names.values()):
            problems.add("", f"no category is one of {', '.join(PERSON_NAMES)}; there are: {self._shown()}")
            problems.raise_if_any()
        given = entry.get("category_id")
        name = self.names.get(_key(given))
        if name is None:
            problems.add(place, f"category_id {shown(given)} is no category of this file")
        return name is not None and name.lower() in PERSON_NAMES

    def _shown(self) -> str:
        names = [_readable(name) for name in (self.names or {}).values()]
        more = [f"{len(names) - MOST_NAMED} more"] * (len(names) > MOST_NAMED)
        return ", ".join([*names[:MOST_NAMED], *more]) or "none"


def _key(value: Any) -> str:
    return str(value) if type(value) in (int, str) else shown(value)


def _readable(name: str) -> str:
    return name if name.isprintable() and 0 < len(name) <= 40 else shown(name)
