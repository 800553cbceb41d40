"""Derivatives that no image uses: what imports left that failed, were cancelled or killed.

Their names are digests of their bytes, so whoever makes the same picture counts on the file that is there.
Therefore nobody deletes his own at failure. They go here, a day later and while no import is under way:
each holds a lock, shared, that the kernel lets go of when its process dies.
"""

from __future__ import annotations

import fcntl
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime, timedelta
from itertools import islice
from pathlib import Path
from typing import BinaryIO

from django.conf import settings
from django.core.files.storage import FileSystemStorage, default_storage
from django.db.models import Q

from gtm_hit.models import BoardPicture, DeskPicture, Image

KEPT = timedelta(days=1)
TOGETHER = 400  # digests in one query


@contextmanager
def pictures_in_use() -> Iterator[None]:
    """Around an import, from its first look at what is stored to the commit of its rows."""
    with _lock_file() as file:
        fcntl.flock(file, fcntl.LOCK_SH)
        yield


def remove_unused_pictures(now: datetime) -> int:
    """How many files were removed. Does nothing while an import is under way, or in an object store."""
    if not isinstance(default_storage, FileSystemStorage):
        return 0
    with _lock_file() as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return 0
        old, removed = _old_files(now), 0
        while together := list(islice(old, TOGETHER)):
            removed += _remove_unused(together)
        return removed


def _lock_file() -> BinaryIO:
    settings.DATA_DIR.mkdir(parents=True, exist_ok=True)
    return (settings.DATA_DIR / "pictures.lock").open("wb")


def _old_files(now: datetime) -> Iterator[Path]:
    """Also what a killed process had not yet given its name."""
    oldest = (now - KEPT).timestamp()
    for path in Path(default_storage.path("images")).glob("??/*"):
        if path.stat().st_mtime < oldest:
            yield path


def _remove_unused(paths: Sequence[Path]) -> int:
    digests = {path.stem for path in paths}
    used = _used(digests)
    unused = [path for path in paths if path.stem not in used]
    for path in unused:
        path.unlink(missing_ok=True)
    return len(unused)


def _used(digests: set[str]) -> set[str]:
    """By frames, or on a desk, where undoing may bring pictures back."""
    used: set[str] = set()
    either = Q(light_digest__in=digests) | Q(full_digest__in=digests)
    for rows in (Image.objects, BoardPicture.objects, DeskPicture.objects):
        for pair in rows.filter(either).values_list("light_digest", "full_digest"):
            used.update(pair)
    return used
