"""Long lists in a JSON object, entry by entry: what one entry becomes is all that is kept of it.

A list of empty objects takes forty times the memory of its text once it is made of Python's objects.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from gtm_hit.formats.problems import FormatError, Problem, shown
from gtm_hit.formats.strict_json import DECODER

MOST_ENTRIES = 10_000_000  # a hundred bytes for each of them is a gigabyte

_SPACE = re.compile(r"[ \t\n\r]*")
Take = Callable[[int, Any], None]
"""Told the index of an entry and its value."""


def read_object(text: str, path: str, lists: Mapping[str, Take]) -> dict[str, Any]:
    """The object in `text`; entry by entry is handed on of those values named in `lists` that are lists.

    An empty list stands for them in the answer. Raises FormatError for what is not JSON or no object.
    """
    try:
        return _Reader(text, lists).whole()
    except (ValueError, RecursionError) as error:
        reason = f"not JSON that can be read: {shown(str(error))}"
        raise FormatError([Problem(path, "", reason)]) from error


class _Reader:
    def __init__(self, text: str, lists: Mapping[str, Take]) -> None:
        self.text = text
        self.lists = lists
        self.at = 0

    def whole(self) -> dict[str, Any]:
        found: dict[str, Any] = {}
        self._expect("{")
        if not self._is_next("}"):
            while True:
                key = self._value()
                if not isinstance(key, str):
                    raise ValueError("a name is not a text")
                self._expect(":")
                take = self.lists.get(key)
                found[key] = self._entries(take) if take and self._is_next("[") else self._value()
                if self._is_next("}"):
                    break
                self._expect(",")
        if self._peek():
            raise ValueError(f"extra data at character {self.at}")
        return found

    def _entries(self, take: Take) -> list[Any]:
        if self._is_next("]"):
            return []
        for index in range(MOST_ENTRIES):
            take(index, self._value())
            if self._is_next("]"):
                return []
            self._expect(",")
        raise ValueError(f"more than {MOST_ENTRIES} entries in a list")

    def _value(self) -> Any:
        self._peek()
        value, self.at = DECODER.raw_decode(self.text, self.at)
        return value

    def _peek(self) -> str:
        match = _SPACE.match(self.text, self.at)
        self.at = match.end() if match else self.at
        return self.text[self.at : self.at + 1]

    def _is_next(self, sign: str) -> bool:
        """Goes past it if so."""
        if self._peek() != sign:
            return False
        self.at += 1
        return True

    def _expect(self, sign: str) -> None:
        if not self._is_next(sign):
            raise ValueError(f"no {sign} at character {self.at}")
