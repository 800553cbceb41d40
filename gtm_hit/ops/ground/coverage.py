"""How much of a dataset's ground its cameras see, counted from the rectangle table."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from django.conf import settings
from PIL import Image as Picture

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.steps import Steps
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Dataset

# From "one camera" to "all of them": lighter to darker, also without seeing colours.
LIGHTEST = (0xCF, 0xE8, 0xEC)
DARKEST = (0x0B, 0x3A, 0x56)
UNSEEN = (0xFF, 0xFF, 0xFF)


@dataclass(frozen=True, eq=False)
class Coverage:
    """Positions by the number of cameras that see a person standing there.

    digest : SHA-256 of the picture, hex
    counts : positions seen by exactly 0, 1 … N cameras
    middles : (N, 2) metres, the middle of what each camera sees; NaN for a camera that sees nothing
    picture : PNG, one pixel per position; the longer side of the grid runs to the right (see GroundMap)
    """

    digest: str
    counts: list[int]
    middles: np.ndarray
    picture: bytes

    @property
    def mean(self) -> float:
        """Cameras per position."""
        return sum(number * count for number, count in enumerate(self.counts)) / sum(self.counts)


def table(
    dataset: Dataset, progress: Steps | None = None, cameras: Sequence[Camera] | None = None
) -> RectangleTable:
    """The dataset's rectangle table; built when this machine does not have it yet.

    `cameras`: those of a calibration read before, which may not be in place any more.
    """
    return RectangleTable.build(
        settings.TABLES_ROOT,
        cameras if cameras is not None else dataset.calibrated_cameras(),
        dataset.grid,
        dataset.cylinder,
        dataset.rule,
        progress,
    )


def coverage(dataset: Dataset) -> Coverage:
    return _coverage(table(dataset).path)


def shade(cameras: int, most: int) -> tuple[int, int, int]:
    """The colour of a position that so many of `most` cameras see."""
    if cameras == 0:
        return UNSEEN
    part = (cameras - 1) / max(most - 1, 1)
    red, green, blue = (
        round(light + (dark - light) * part) for light, dark in zip(LIGHTEST, DARKEST, strict=True)
    )
    return red, green, blue


@lru_cache(maxsize=32)
def _coverage(path: Path) -> Coverage:
    found = RectangleTable.open(path)
    grid = found.grid
    seen = np.zeros(grid.count, dtype=np.uint8)
    middles = np.full((found.cameras_count, 2), np.nan)
    for camera in range(found.cameras_count):
        visible = found.visible(camera)
        seen += visible
        positions = np.flatnonzero(visible)
        if len(positions):
            middles[camera] = grid.metres(positions).mean(axis=0)
    counts = np.bincount(seen, minlength=found.cameras_count + 1).tolist()
    picture = _picture(seen.reshape(grid.rows, grid.columns), found.cameras_count)
    return Coverage(hashlib.sha256(picture).hexdigest(), counts, middles, picture)


def _picture(seen: np.ndarray, most: int) -> bytes:
    """`seen` is (rows, columns): Y grows with the row, X with the column."""
    rows, columns = seen.shape
    upright = seen.T if rows > columns else np.flipud(seen)
    picture = Picture.fromarray(np.ascontiguousarray(upright), mode="P")
    picture.putpalette([value for cameras in range(most + 1) for value in shade(cameras, most)])
    stream = io.BytesIO()
    picture.save(stream, "PNG", optimize=True)
    return stream.getvalue()
