"""The grid files of a dataset's cameras: made once from the rectangle table, and kept beside it."""

from __future__ import annotations

from pathlib import Path
from threading import Lock
from uuid import uuid4

from django.conf import settings

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.grid_file import encode, grid_file_digest
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Camera as CameraRow
from gtm_hit.models import Dataset
from gtm_hit.ops.ground.coverage import table

_making = (
    Lock()
)  # a browser asks for one camera after the other, several ask for the same: one table is enough


def digest_of(dataset: Dataset, camera: Camera) -> str:
    return grid_file_digest(camera, dataset.grid, dataset.cylinder, dataset.rule)


def path_of(digest: str) -> Path:
    return Path(settings.TABLES_ROOT) / f"grid-{digest}.gz"


def find(row: CameraRow) -> Path:
    """The file of a camera as it is calibrated now; made, with the table, where this machine lacks it."""
    path = path_of(digest_of(row.dataset, row.calibrated))
    if not path.exists():
        with _making:
            if not path.exists():
                make(row.dataset, table(row.dataset), [row.calibrated])
    return path


def make(dataset: Dataset, rectangles: RectangleTable, cameras: list[Camera]) -> None:
    """Those files of `cameras` that are missing."""
    for camera in cameras:
        path = path_of(digest_of(dataset, camera))
        if not path.exists():
            _write(path, encode(rectangles.boxes(camera.index), camera, rectangles.grid))


def _write(path: Path, data: bytes) -> None:
    """Whole or not at all; of several processes the last rename wins with the same bytes."""
    unfinished = path.with_name(f".{path.name}.{uuid4().hex}")
    try:
        unfinished.write_bytes(data)
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)
