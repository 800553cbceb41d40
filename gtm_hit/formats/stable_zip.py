"""Zip archives whose bytes depend on names, contents and order alone: same export, same SHA-256.

Deflated bytes also depend on the build of zlib; stored ones do not.
"""

from __future__ import annotations

import shutil
import zipfile
from collections import deque
from collections.abc import Collection, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from gtm_hit.formats.files import replacing

# The first moment a zip archive can name.
_MOMENT = (1980, 1, 1, 0, 0, 0)
_PERMISSIONS = 0o100644 << 16
_UNIX = 3
# Compressing these again costs time and saves nothing.
_COMPRESSED = (".png", ".jpg", ".jpeg", ".webp", ".zip", ".gz")
# So that memory stays bounded when files come faster than they are compressed.
_BYTES_TOGETHER = 1 << 20
_MOST_WAITING = 8


class StableZip:
    """An archive under way. Files are compressed beside whoever makes them: zlib lets go of Python's lock."""

    def __init__(self, archive: zipfile.ZipFile, pool: ThreadPoolExecutor, prefix: str):
        self._archive = archive
        self._pool = pool
        self._prefix = f"{prefix}/" if prefix else ""
        self._names: set[str] = set()
        self._together: list[tuple[str, Path | bytes]] = []
        self._bytes = 0
        self._waiting: deque[Future[None]] = deque()

    def add(self, name: str, source: Path | bytes) -> None:
        """Append a file; one given by its path must not change before the archive is complete.

        Raises ValueError for a name that would be unpacked outside the folder, or was there before, and
        whatever went wrong with an earlier file.
        """
        _check(name, self._names)
        self._names.add(name)
        self._together.append((self._prefix + name, source))
        self._bytes += len(source) if isinstance(source, bytes) else 0
        if self._bytes >= _BYTES_TOGETHER:
            self._hand_over()

    def finish(self) -> None:
        self._hand_over()
        while self._waiting:
            self._waiting.popleft().result()

    def _hand_over(self) -> None:
        self._waiting.append(self._pool.submit(self._write, self._together))
        self._together, self._bytes = [], 0
        if len(self._waiting) > _MOST_WAITING:
            self._waiting.popleft().result()

    def _write(self, files: list[tuple[str, Path | bytes]]) -> None:
        for name, source in files:
            info = zipfile.ZipInfo(name, _MOMENT)
            info.create_system = _UNIX
            info.external_attr = _PERMISSIONS
            deflate = not name.lower().endswith(_COMPRESSED)
            info.compress_type = zipfile.ZIP_DEFLATED if deflate else zipfile.ZIP_STORED
            if isinstance(source, bytes):
                self._archive.writestr(info, source)
                continue
            info.file_size = source.stat().st_size
            with self._archive.open(info, "w") as target, source.open("rb") as stream:
                shutil.copyfileobj(stream, target, 1 << 20)


@contextmanager
def stable_zip(path: Path, prefix: str = "") -> Iterator[StableZip]:
    """An archive that appears under `path` complete or not at all; `prefix` is a folder name inside it."""
    with replacing(path) as stream, zipfile.ZipFile(stream, "w") as archive:
        pool = ThreadPoolExecutor(1, "zip")
        try:
            made = StableZip(archive, pool, prefix)
            yield made
            made.finish()
        finally:
            pool.shutdown(cancel_futures=True)


def _check(name: str, taken: Collection[str]) -> None:
    path = PurePosixPath(name)
    if (
        path.is_absolute()
        or ".." in path.parts
        or str(path) != name
        or "\\" in name
        or "\0" in name
        or name == "."
    ):
        raise ValueError(f"not a path below a folder: {name!r}")
    if name in taken:
        raise ValueError(f"there twice: {name!r}")
