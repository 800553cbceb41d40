"""Zip archives whose bytes depend on names and contents alone: same export, same archive, same SHA-256.

Deflated bytes also depend on the build of zlib; stored ones do not.
"""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath
from typing import BinaryIO

from gtm_hit.formats.files import replacing

Progress = Callable[[int, int], None]

# The first moment a zip archive can name.
_MOMENT = (1980, 1, 1, 0, 0, 0)
_PERMISSIONS = 0o100644 << 16
_UNIX = 3
# Compressing these again costs time and saves nothing.
_COMPRESSED = {".png", ".jpg", ".jpeg", ".webp", ".zip", ".gz"}


def write_folder_zip(
    path: Path, folder: Path, prefix: str = "", compressed: bool = True, progress: Progress | None = None
) -> None:
    """Archives all files below a folder; `prefix` is a folder name inside the archive."""
    files = {name.relative_to(folder).as_posix(): name for name in folder.rglob("*") if name.is_file()}
    if prefix:
        files = {f"{prefix}/{name}": source for name, source in files.items()}
    with replacing(path) as stream:
        write_zip(stream, files, compressed, progress)


def write_zip(
    stream: BinaryIO,
    files: Mapping[str, Path | bytes],
    compressed: bool = True,
    progress: Progress | None = None,
) -> None:
    """Writes the files in the order of their names; `progress` is told files done and files in all.

    Raises ValueError for a name that would be unpacked outside the folder.
    """
    with zipfile.ZipFile(stream, "w") as archive:
        for done, name in enumerate(sorted(files), start=1):
            _add(archive, name, files[name], compressed)
            if progress:
                progress(done, len(files))


def _add(archive: zipfile.ZipFile, name: str, source: Path | bytes, compressed: bool) -> None:
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
    info = zipfile.ZipInfo(name, _MOMENT)
    info.create_system = _UNIX
    info.external_attr = _PERMISSIONS
    deflate = compressed and path.suffix.lower() not in _COMPRESSED
    info.compress_type = zipfile.ZIP_DEFLATED if deflate else zipfile.ZIP_STORED
    info.file_size = len(source) if isinstance(source, bytes) else source.stat().st_size
    with archive.open(info, "w") as target:
        if isinstance(source, bytes):
            target.write(source)
        else:
            with source.open("rb") as stream:
                shutil.copyfileobj(stream, target, 1 << 20)
