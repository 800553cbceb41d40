from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from pathlib import Path

from gtm_hit.formats.files import reason_of
from gtm_hit.formats.problems import ProblemList

_NUMBER_AT_END = re.compile(r"(?<![0-9])([0-9]{1,9})$")


class DatasetFolder:
    """Lists what lies in one folder and never leaves it, whatever the links in it say."""

    def __init__(self, root: Path, problems: ProblemList) -> None:
        self.root = root.resolve()
        self.problems = problems

    def at(self, chosen: Path) -> DatasetFolder:
        """For a folder that was named explicitly: it may be elsewhere, what it holds may not lead further."""
        if chosen.resolve().is_relative_to(self.root):
            return self
        return DatasetFolder(chosen, self.problems)

    def entries(self, folder: Path) -> list[Path]:
        """What lies in a folder, in natural order, without hidden things and links that lead out."""
        if not self._holds(folder):
            return []
        try:
            with os.scandir(folder) as found:
                visible = [entry for entry in found if entry.name[0] not in "._@"]
        except OSError as error:
            self.problems.add("", f"cannot be read: {reason_of(error)}", folder)
            return []
        # Only a link can leave a folder that is inside; resolving every image of a dataset takes seconds.
        kept = [entry.name for entry in visible if not entry.is_symlink() or self._holds(folder / entry.name)]
        return [folder / name for name in sorted(kept, key=natural_key)]

    def files(self, folder: Path, suffixes: set[str]) -> list[Path]:
        return [path for path in self.entries(folder) if path.suffix.lower() in suffixes]

    def by_number(self, folder: Path, suffixes: set[str]) -> dict[int, Path]:
        """Files by the frame number their names end with."""
        found: dict[int, Path] = {}
        for path in self.files(folder, suffixes):
            match = _NUMBER_AT_END.search(path.stem)
            if match is None:
                self.problems.add("", "the name does not end with a frame number of at most 9 digits", path)
            elif (first := found.setdefault(int(match[1]), path)) is not path:
                self.problems.add("", f"has the same frame number as {first.name}", path)
        return dict(sorted(found.items()))

    def by_name(self, paths: Iterable[Path], name_of: Callable[[Path], str]) -> dict[str, Path]:
        found: dict[str, Path] = {}
        for path in paths:
            if (first := found.setdefault(name_of(path), path)) is not path:
                self.problems.add("", f"has the same name as {first.name}", path)
        return found

    def _holds(self, path: Path) -> bool:
        try:
            if path.resolve(strict=True).is_relative_to(self.root):
                return True
            self.problems.add("", "leads out of the dataset folder", path)
        except (OSError, RuntimeError):  # RuntimeError: links that lead to each other
            self.problems.add("", "leads nowhere", path)
        return False


def natural_key(name: str) -> tuple[list[str | int], str]:
    """Sorts C10 after C2."""
    parts = re.split(r"([0-9]{1,18})", name)
    return [int(part) if index % 2 else part for index, part in enumerate(parts)], name
