"""One camera's part of the rectangle table, small enough to travel: the workbench looks boxes up in it.

A gzip stream; unpacked it holds, all numbers little-endian:

    8 bytes      MAGIC
    6 × uint32   columns, rows, visible positions, runs, exceptions, planes
    uint32       for each run: how many positions it has; not visible (first) and visible take turns
    uint32       for each exception: its difference, zigzag
    uint8        planes xmin, ymin, xmax, ymax, of six planes also x and y of the foot: for each visible
                 position its difference, zigzag; 255 means that the difference is the next of the
                 exceptions, which are in the order of the planes

A value's difference is to the same value of the position before it in its row, where that is not visible to
the position one row before, where that is not visible either to 0. static/geometry/grid_file.js reads it.

The foot is where the position itself is seen, in quarters of a pixel. It is there for cameras whose model the
browser does not know: a box does not tell it, since in wide views people lean.
"""

from __future__ import annotations

import gzip
import hashlib
import struct

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, CameraModel, project
from gtm_hit.geometry.cylinder import Cylinder, FootRule, is_visible
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.table import Boxes, table_digest

VERSION = 1  # goes into the address: count up when the file changes
MAGIC = b"GTMGRID1"
EXCEPTION = 255
LEVEL = 6  # level 9 takes ten times as long for a fifth less
FOOT_PARTS = 4  # of a pixel


def grid_file_digest(camera: Camera, grid: Grid, cylinder: Cylinder, rule: FootRule) -> str:
    """SHA-256, hex, of all the file follows from: equal digests mean equal files."""
    numbers = table_digest([camera], grid, cylinder, rule)
    return hashlib.sha256(f"grid file {VERSION} {numbers}".encode()).hexdigest()


def encode(boxes: Boxes, camera: Camera, grid: Grid) -> bytes:
    """The file of one camera's boxes, (positions, 4); the same boxes give the same bytes."""
    seen = is_visible(boxes)
    values = boxes if camera.model is CameraModel.PINHOLE else np.hstack((boxes, _feet(camera, grid, seen)))
    return encode_values(values, seen, grid)


def encode_values(values: Boxes, seen: NDArray[np.bool_], grid: Grid) -> bytes:
    """The file of (positions, planes) numbers, all 0 where not `seen` (positions,)."""
    planes = values.shape[1]
    shaped = values.reshape(grid.rows, grid.columns, planes).astype(np.int32)
    visible = seen.reshape(grid.rows, grid.columns)
    differences = (shaped - _before(shaped, visible))[visible].T  # (planes, visible positions)
    zigzag = (differences << 1) ^ (differences >> 31)
    exceptions = zigzag[zigzag >= EXCEPTION]
    runs = _runs(seen)
    counts = (grid.columns, grid.rows, zigzag.shape[1], len(runs), len(exceptions), planes)
    parts = [MAGIC, struct.pack("<6I", *counts), runs.astype("<u4").tobytes()]
    parts += [exceptions.astype("<u4").tobytes(), np.minimum(zigzag, EXCEPTION).astype(np.uint8).tobytes()]
    return gzip.compress(b"".join(parts), LEVEL, mtime=0)


def _feet(camera: Camera, grid: Grid, seen: NDArray[np.bool_]) -> Boxes:
    """(positions, 2), 0 where not seen."""
    positions = np.flatnonzero(seen)
    ground = np.column_stack((grid.metres(positions), np.zeros(len(positions))))
    parts = np.rint(project(camera, ground) * FOOT_PARTS)
    feet = np.zeros((grid.count, 2), np.int16)
    feet[positions] = np.clip(parts, np.iinfo(np.int16).min, np.iinfo(np.int16).max)
    return feet


def _before(values: NDArray[np.int32], visible: NDArray[np.bool_]) -> NDArray[np.int32]:
    """What each position's values are told by their difference to. Values are 0 where not visible."""
    left, above = np.zeros_like(values), np.zeros_like(values)
    left[:, 1:], above[1:] = values[:, :-1], values[:-1]
    has_left = np.zeros_like(visible)
    has_left[:, 1:] = visible[:, :-1]
    return np.where(has_left[..., None], left, above)


def _runs(visible: NDArray[np.bool_]) -> NDArray[np.int64]:
    changes = np.flatnonzero(np.diff(visible, prepend=False))
    return np.diff(changes, prepend=0, append=visible.size)
