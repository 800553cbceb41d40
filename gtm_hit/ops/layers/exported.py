"""Where an export of ours keeps each format, so that its folder can be taken in as it came out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from gtm_hit.formats.layout import ANNOTATION_FOLDER

_PARTS: Mapping[str, tuple[str, ...]] = {
    "wildtrack": (ANNOTATION_FOLDER, f"multiviewx/{ANNOTATION_FOLDER}"),
    "text": ("frame_column_row/people.txt",),
    "mot": ("mot",),
    "coco": ("coco",),
    "csv": ("people.csv",),
}


def part_of(path: Path, kind: str) -> Path:
    """The part of the folder of an export or a release that holds `kind`; `path` where there is none.

    A link that leads out of the folder is no part of it.
    """
    root = path.resolve()
    for name in _PARTS[kind]:
        part = path / name
        if part.exists() and part.resolve().is_relative_to(root):
            return part
    return path
