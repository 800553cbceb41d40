from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from gtm_hit.formats.problems import FormatError, Problem


def read_source(path: Path, most_bytes: int) -> bytes:
    """All bytes of a file that came from somebody else.

    Raises FormatError for a file that is missing, unreadable, not plain, empty, or above `most_bytes`.
    """
    check_source(path)
    try:
        with path.open("rb") as stream:
            data = stream.read(most_bytes + 1)
    except (OSError, ValueError) as error:
        raise FormatError([Problem(str(path), "", f"cannot be read: {reason_of(error)}")]) from error
    if not data:
        raise FormatError([Problem(str(path), "", "the file is empty")])
    if len(data) > most_bytes:
        raise FormatError([Problem(str(path), "", f"larger than {most_bytes} bytes")])
    return data


def check_source(path: Path) -> None:
    """Raises FormatError for what is not a plain file: a named pipe or a device would block or never end."""
    if not path.is_file():
        raise FormatError([Problem(str(path), "", "not a plain file" if path.exists() else "no such file")])


def reason_of(error: OSError | ValueError) -> str:
    """An operating-system error without the path, which the problem names already."""
    return (error.strerror if isinstance(error, OSError) else None) or type(error).__name__


@contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """A stream whose bytes appear under `path` all at once, or not at all when the block fails.

    After the block they are there for good, also after a power cut.
    """
    make_folder(path.parent)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".tmp", dir=path.parent)
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            yield stream
            stream.flush()
            # A rename may reach the disk before the bytes do: an empty file under the final name.
            os.fsync(stream.fileno())
        # mkstemp makes files only their owner can read; exports are meant to be shared.
        temporary.chmod(0o644)
        temporary.replace(path)
        sync(path.parent)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def make_folder(path: Path) -> None:
    """With its parents, all of them there after a power cut, too."""
    if not path.is_dir():
        make_folder(path.parent)
        path.mkdir(exist_ok=True)
        sync(path.parent)


def sync(path: Path) -> None:
    """Wait until a file's bytes, or the names in a folder, are on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def sync_tree(folder: Path) -> None:
    """A folder with everything below it."""
    for root, _folders, names in os.walk(folder):
        for name in names:
            sync(Path(root) / name)
        sync(Path(root))


def write_bytes(path: Path, data: bytes) -> None:
    with replacing(path) as stream:
        stream.write(data)
