"""The files of an export: digests and archive are made while they are written, not by reading them again."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, cast

from gtm_hit.formats.manifest import FileEntry
from gtm_hit.formats.stable_zip import StableZip


class ExportFiles:
    """Files below one folder, and in an archive in the order they were finished.

    `entries` is what a manifest says of them.
    """

    def __init__(self, folder: Path, archive: StableZip) -> None:
        self.folder = folder
        self.archive = archive
        self.entries: dict[str, FileEntry] = {}
        self._made: set[Path] = set()

    def write(self, name: str, data: bytes) -> None:
        with self._path(name).open("wb") as file:
            file.write(data)
        self._note(name, len(data), hashlib.sha256(data).hexdigest(), data)

    @contextmanager
    def stream(self, name: str) -> Iterator[BinaryIO]:
        """For what is written bit by bit."""
        with self._path(name).open("wb") as file:
            digesting = _Digesting(file)
            yield cast(BinaryIO, digesting)
        self._note(name, digesting.size, digesting.digest.hexdigest(), self.folder / name)

    def path(self, name: str) -> Path:
        """For a writer that makes the file itself; `note` it afterwards."""
        return self._path(name)

    def note(self, name: str) -> None:
        with (self.folder / name).open("rb") as stream:
            digest = hashlib.file_digest(stream, "sha256").hexdigest()
            self._note(name, stream.tell(), digest, self.folder / name)

    def _path(self, name: str) -> Path:
        path = self.folder / name
        if path.parent not in self._made:  # asking the disk for each of 36,000 files takes seconds
            path.parent.mkdir(parents=True, exist_ok=True)
            self._made.add(path.parent)
        return path

    def _note(self, name: str, size: int, digest: str, content: Path | bytes) -> None:
        self.entries[name] = FileEntry(size, digest)
        self.archive.add(name, content)


class _Digesting:
    def __init__(self, file: BinaryIO) -> None:
        self.file = file
        self.size = 0
        self.digest = hashlib.sha256()

    def write(self, data: bytes) -> int:
        self.size += len(data)
        self.digest.update(data)
        return self.file.write(data)
