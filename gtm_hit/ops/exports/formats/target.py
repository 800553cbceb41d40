"""What a format is given, and what it must do."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Dataset, Frame, Layer
from gtm_hit.ops.exports.files import ExportFiles
from gtm_hit.ops.exports.frames import Chunk
from gtm_hit.ops.jobs.progress import Progress

RECTANGLES = "writing rectangles"


@dataclass(frozen=True, eq=False)
class Target:
    """One export under way; files opened in `open_files` are closed at its end, also when it fails."""

    files: ExportFiles
    layer: Layer
    cameras: Sequence[Camera]
    table: RectangleTable
    report: Progress
    open_files: ExitStack

    @property
    def dataset(self) -> Dataset:
        return self.layer.dataset

    @cached_property
    def numbers(self) -> list[int]:
        """Of all frames of the dataset, in order."""
        found = Frame.objects.filter(dataset=self.dataset).order_by("number")
        return list(found.values_list("number", flat=True))


class Writer(Protocol):
    """Told every chunk in order, then the end."""

    def add(self, chunk: Chunk) -> None: ...

    def finish(self) -> None: ...
