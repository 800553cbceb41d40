"""The rectangles of every position in every view: computed once, kept in one memory-mapped file.

The file is named by the digest of everything the rectangles depend on. It starts with a header of
`HEADER_BYTES`: `MAGIC`, then a JSON object padded with spaces; after it come little-endian int16 boxes,
(cameras, positions, 4), xmin ymin xmax ymax, all 0 where not visible.
"""

from __future__ import annotations

import hashlib
import json
import math
import mmap
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict
from pathlib import Path
from uuid import uuid4

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gtm_hit.geometry import lens
from gtm_hit.geometry.camera import Camera, CameraModel
from gtm_hit.geometry.cylinder import BLOCK, Cylinder, FootRule, fill_block, is_visible
from gtm_hit.geometry.errors import GeometryError
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.steps import Steps

VERSION = 1  # goes into the digest: count up when the rule or the file changes
MAGIC = b"GTM rectangles\n"
HEADER_BYTES = 4096
BOX_BYTES = 8
TASKS_PER_CAMERA = 8
USUAL = CameraModel.PINHOLE

Boxes = NDArray[np.int16]


class TableError(GeometryError):
    """A file that is no rectangle table, or a damaged one."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: {reason}")


def table_digest(cameras: Sequence[Camera], grid: Grid, cylinder: Cylinder, rule: FootRule) -> str:
    """SHA-256, hex, of all the numbers rectangles depend on; names and indices are not among them."""
    numbers = [grid.columns, grid.rows, grid.step, grid.origin_x, grid.origin_y]
    numbers += [cylinder.radius, cylinder.height, len(cameras)]
    for camera in cameras:
        numbers += [camera.width, camera.height]
        for array in (camera.matrix, camera.rvec, camera.tvec, lens.padded(camera.distortion)):
            numbers += array.ravel().tolist()
    canonical = np.array(numbers, dtype="<f8") + 0.0  # makes -0.0 and 0.0 one number
    # Only models other than the usual one are named: tables without them keep their digests.
    models = [f" {place}:{each.model}" for place, each in enumerate(cameras) if each.model != USUAL]
    head = f"{VERSION} {FootRule(rule)}{''.join(models)}\n"
    return hashlib.sha256(head.encode() + canonical.tobytes()).hexdigest()


class RectangleTable:
    """Read-only; holds no more memory than the pages that were looked at."""

    def __init__(self, path: Path, digest: str, grid: Grid, boxes: Boxes) -> None:
        self.path = path
        self.digest = digest
        self.grid = grid
        self._boxes = boxes

    @classmethod
    def build(
        cls,
        folder: Path,
        cameras: Sequence[Camera],
        grid: Grid,
        cylinder: Cylinder,
        rule: FootRule,
        progress: Steps | None = None,
    ) -> RectangleTable:
        """Open the table of these numbers, computing it first unless a sound file is there already.

        Safe in several processes at once: each writes a file of its own, and the last rename wins with
        the same bytes.
        """
        digest = table_digest(cameras, grid, cylinder, rule)
        path = folder / f"rectangles-{digest}.bin"
        try:
            return cls.open(path)
        except (FileNotFoundError, TableError):
            folder.mkdir(parents=True, exist_ok=True)
        header = _header(digest, grid, len(cameras))
        unfinished = folder / f".{path.name}.{uuid4().hex}"
        try:
            with unfinished.open("x+b") as file:
                _write_table(file.fileno(), header, cameras, grid, cylinder, rule, progress)
            unfinished.replace(path)
        finally:
            unfinished.unlink(missing_ok=True)
        return cls.open(path)

    @classmethod
    def open(cls, path: Path) -> RectangleTable:
        """FileNotFoundError when there is none, TableError when it cannot be trusted."""
        with path.open("rb") as file:
            digest, cameras, grid = _parse_header(path, file.read(HEADER_BYTES))
            size = os.fstat(file.fileno()).st_size
            if size != HEADER_BYTES + cameras * grid.count * BOX_BYTES:
                raise TableError(path, f"{size} bytes are not {cameras} cameras × {grid.count} positions")
            mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        boxes = np.frombuffer(mapped, dtype="<i2", offset=HEADER_BYTES)
        return cls(path, digest, grid, boxes.reshape(cameras, grid.count, 4))

    @property
    def cameras_count(self) -> int:
        return self._boxes.shape[0]

    def rectangles(self, positions: ArrayLike) -> tuple[Boxes, NDArray[np.bool_]]:
        """Boxes (N, cameras, 4) int16 and visibility (N, cameras) of positions (N,); GridError if off it."""
        ids = np.atleast_1d(np.asarray(positions, dtype=np.int64))
        self.grid.check(ids)
        boxes = self._boxes[:, ids].transpose(1, 0, 2)
        return boxes, is_visible(boxes)

    def boxes(self, camera_index: int) -> Boxes:
        """All boxes of one camera, (positions, 4): a view of the file, not a copy."""
        return self._boxes[camera_index]

    def visible(self, camera_index: int) -> NDArray[np.bool_]:
        """Where one camera sees the cylinder, (positions,)."""
        return is_visible(self._boxes[camera_index])


def _header(digest: str, grid: Grid, cameras: int) -> bytes:
    facts = {"version": VERSION, "digest": digest, "cameras": cameras, "grid": asdict(grid)}
    return (MAGIC + json.dumps(facts).encode()).ljust(HEADER_BYTES)


def _parse_header(path: Path, header: bytes) -> tuple[str, int, Grid]:
    if not header.startswith(MAGIC):
        raise TableError(path, "not a rectangle table")
    try:
        facts = json.loads(header.removeprefix(MAGIC))
        version, digest, cameras = facts["version"], facts["digest"], int(facts["cameras"])
        grid = Grid(**facts["grid"])
    except (ValueError, KeyError, TypeError) as error:
        raise TableError(path, "damaged header") from error
    if version != VERSION:
        raise TableError(path, f"version {version}, not {VERSION}")
    return digest, cameras, grid


def _write_table(
    descriptor: int,
    header: bytes,
    cameras: Sequence[Camera],
    grid: Grid,
    cylinder: Cylinder,
    rule: FootRule,
    progress: Steps | None,
) -> None:
    size = HEADER_BYTES + len(cameras) * grid.count * BOX_BYTES
    # Reserve the space: a full disk must be an error here, not a bus error in the middle of the mapping.
    os.posix_fallocate(descriptor, 0, size)
    mapped = mmap.mmap(descriptor, size)  # unmapped when the last array looking at it is gone
    mapped[:HEADER_BYTES] = header
    boxes = np.frombuffer(mapped, dtype="<i2", offset=HEADER_BYTES)
    boxes = boxes.reshape(len(cameras), grid.rows, grid.columns, 4)
    _compute(boxes, cameras, grid, cylinder, rule, progress)
    os.fsync(descriptor)


def _compute(
    boxes: Boxes,
    cameras: Sequence[Camera],
    grid: Grid,
    cylinder: Cylinder,
    rule: FootRule,
    progress: Steps | None,
) -> None:
    """Fill boxes (cameras, rows, columns, 4), with a thread per core: numpy lets go of the lock."""
    columns_together = min(grid.columns, BLOCK)  # one row of a long grid may be all of it
    rows_together = max(1, BLOCK // columns_together)

    def part(number: int, start: int, stop: int) -> None:
        for first in range(start, stop, rows_together):
            rows = np.arange(first, min(first + rows_together, stop))[:, None]
            for left in range(0, grid.columns, columns_together):
                columns = np.arange(left, min(left + columns_together, grid.columns))[None, :]
                block = boxes[number, first : first + rows.size, left : left + columns.size]
                fill_block(cameras[number], grid, cylinder, rule, columns, rows, block)

    share = math.ceil(grid.rows / TASKS_PER_CAMERA)
    parts = [
        (number, start, min(start + share, grid.rows))
        for number in range(len(cameras))
        for start in range(0, grid.rows, share)
    ]
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for done, future in enumerate(as_completed([pool.submit(part, *each) for each in parts]), start=1):
            future.result()
            if progress:
                progress(done, len(parts))
