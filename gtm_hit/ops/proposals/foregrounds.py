"""Foregrounds of the frames that a run has looked at: files beside it, by what they were made of.

A file is named by its run and the digest of the pictures, so it never changes, and a picture that changes has
another one. They go with their run; what runs leave behind whose dataset went, `sweep` removes.
"""

from __future__ import annotations

import logging
from functools import lru_cache
from pathlib import Path

from django.core.files.base import ContentFile
from django.core.files.storage import FileSystemStorage, default_storage

from gtm_hit.formats.files import write_bytes
from gtm_hit.models import ProposalRun
from gtm_hit.vision.masks import Mask, Masks, packed, unpacked

FOLDER = "foregrounds"
AT_HAND = 24  # frames whose foregrounds a process holds: 15 MB each with seven views


def name_of(run: int, pictures: str) -> str:
    return f"{FOLDER}/{run}/{pictures}.npz"


def keep(run: ProposalRun, pictures: str, masks: Masks) -> None:
    """Of the pictures with this digest. Never seen half-written; again: nothing changes."""
    name = name_of(run.pk, pictures)
    if not masks or default_storage.exists(name):
        return
    if isinstance(default_storage, FileSystemStorage):
        write_bytes(Path(default_storage.path(name)), packed(masks))
    else:
        default_storage.save(name, ContentFile(packed(masks)))


def kept(run: ProposalRun, pictures: str) -> dict[str, Mask]:
    """By camera; empty where the run had no background, or kept none."""
    name = name_of(run.pk, pictures)
    return dict(_read(name, default_storage.size(name))) if default_storage.exists(name) else {}


@lru_cache(maxsize=AT_HAND)
def _read(name: str, size: int) -> dict[str, Mask]:
    """Without `size` a number that is given again, after a database was put back, would bring what was."""
    del size
    with default_storage.open(name) as file:
        data = file.read()
    try:
        return unpacked(data)
    except ValueError:
        logging.getLogger(__name__).warning("%s is damaged; people are placed without it", name)
        return {}


def remove(run: int) -> None:
    """All files of a run."""
    folder = f"{FOLDER}/{run}"
    if not default_storage.exists(folder) and isinstance(default_storage, FileSystemStorage):
        return
    for name in default_storage.listdir(folder)[1]:
        default_storage.delete(f"{folder}/{name}")
    default_storage.delete(folder)


def sweep() -> int:
    """Remove the files of runs that are gone; of how many."""
    if isinstance(default_storage, FileSystemStorage) and not default_storage.exists(FOLDER):
        return 0
    runs = {int(name) for name in default_storage.listdir(FOLDER)[0] if name.isdecimal()}
    gone = runs - set(ProposalRun.objects.filter(pk__in=runs).values_list("pk", flat=True))
    for run in gone:
        remove(run)
    return len(gone)
