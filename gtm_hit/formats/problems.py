from __future__ import annotations

import reprlib
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

MOST_PROBLEMS = 200


@dataclass(frozen=True)
class Problem:
    """What is wrong in one file: the file, the place in it, and the reason in words."""

    path: str
    place: str
    reason: str

    def __post_init__(self) -> None:
        # Names in archives may hold signs that a terminal obeys.
        for name in ("path", "place", "reason"):
            object.__setattr__(self, name, plain(getattr(self, name)))

    def __str__(self) -> str:
        return ": ".join(part for part in (self.path, self.place, self.reason) if part)


class FormatError(Exception):
    """Everything wrong with what was read, collected before giving up."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))

    def relative_to(self, folder: Path) -> FormatError:
        """The same problems seen from `folder`, so that no message tells where a server keeps its data."""
        return FormatError(
            replace(problem, path=_seen_from(folder, problem.path)) for problem in self.problems
        )


class ProblemList:
    """Collects the problems of a reading; gives up at once when there are too many to be worth listing."""

    def __init__(self, path: Path | str) -> None:
        self.path = str(path)
        self.found: list[Problem] = []

    def __bool__(self) -> bool:
        return bool(self.found)

    def add(self, place: str, reason: str, path: Path | str | None = None) -> None:
        # A file name need not be text; a message must be.
        name = str(self.path if path is None else path).encode("utf-8", "backslashreplace").decode()
        self.extend([Problem(name, place, reason)])

    def extend(self, problems: Iterable[Problem]) -> None:
        for problem in problems:
            if len(self.found) == MOST_PROBLEMS:
                self.found.append(
                    Problem(self.path, "", f"more than {MOST_PROBLEMS} problems, the rest is not listed")
                )
                raise FormatError(self.found)
            self.found.append(problem)

    def raise_if_any(self) -> None:
        if self.found:
            raise FormatError(self.found)


def shown(value: object) -> str:
    """A value as it may stand in a message: short, one line, plain characters."""
    return _SHORT.repr(value)


def plain(text: str) -> str:
    """The text on one line, with what is no sign one sees written out."""
    if text.isprintable():
        return text
    return "".join(
        sign if sign.isprintable() else sign.encode("unicode_escape", "backslashreplace").decode()
        for sign in text
    )


class _Short(reprlib.Repr):
    def __init__(self) -> None:
        super().__init__()
        self.maxstring = self.maxother = self.maxlong = 40

    def repr1(self, x: object, level: int) -> str:
        return super().repr1(x, level).encode("ascii", "backslashreplace").decode()


_SHORT = _Short()


def _seen_from(folder: Path, path: str) -> str:
    for start in (folder, folder.resolve()):
        if Path(path).is_relative_to(start):
            return str(Path(path).relative_to(start))
    return path
