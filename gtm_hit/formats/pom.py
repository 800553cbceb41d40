"""The table of rectangles as text, as published with WILDTRACK for the Probabilistic Occupancy Map (POM).

    WIDTH 12                                  metres along X
    HEIGHT 36                                 metres along Y
    NB_WIDTH 480                              columns
    NB_HEIGHT 1440                            rows
    MAN_RAY 0.16                              metres
    MAN_HEIGHT 1.8                            metres
    REDUCTION 1
    ORIGINE_X -3.0                            metres
    ORIGINE_Y -9.0                            metres
    NB_CAMERA 7
    RECTANGLE 0 0 notvisible                  camera, position
    RECTANGLE 0 1 1510 139 1561 299           camera, position, xmin, ymin, xmax, ymax

Readers take the header by the place of its lines as well as by name, so it is always written whole and in
this order. MultiviewX is published without a header.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from gtm_hit.formats.files import replacing
from gtm_hit.geometry.cylinder import Cylinder
from gtm_hit.geometry.grid import Grid
from gtm_hit.geometry.steps import Steps

BLOCK_LINES = 65_536

_VISIBLE = "RECTANGLE {camera} %d %d %d %d %d\n"
_NOT_VISIBLE = "RECTANGLE {camera} %d notvisible\n"


@dataclass(frozen=True)
class PomHeader:
    """What the table was made with. `reduction` is the factor the images were scaled down by."""

    grid: Grid
    cylinder: Cylinder
    cameras: int
    reduction: float = 1.0


class Rectangles(Protocol):
    """What is written: a rectangle table, or anything that answers alike."""

    def boxes(self, camera_index: int) -> np.ndarray: ...

    def visible(self, camera_index: int) -> np.ndarray: ...


def write_pom(
    path: Path, header: PomHeader, table: Rectangles, progress: Steps | None = None, headed: bool = True
) -> None:
    """Writes one line per camera and position; `progress` is told positions done and positions in all.

    With `headed` false the header is left out, as MultiviewX's readers want it.
    """
    count = header.grid.count
    with replacing(path) as stream:
        if headed:
            stream.write(header_text(header).encode())
        for camera in range(header.cameras):
            boxes, visible = table.boxes(camera), table.visible(camera)
            if boxes.shape != (count, 4) or visible.shape != (count,):
                raise ValueError(f"camera {camera} has boxes {boxes.shape} for {count} positions")
            for start in range(0, count, BLOCK_LINES):
                block = slice(start, min(start + BLOCK_LINES, count))
                stream.write(_lines(camera, start, boxes[block], visible[block]))
                if progress:
                    progress(camera * count + block.stop, header.cameras * count)


def header_text(header: PomHeader) -> str:
    width, height = header.grid.extent
    return (
        f"WIDTH {width:.12g}\nHEIGHT {height:.12g}\n"
        f"NB_WIDTH {header.grid.columns}\nNB_HEIGHT {header.grid.rows}\n"
        f"MAN_RAY {header.cylinder.radius!r}\nMAN_HEIGHT {header.cylinder.height!r}\n"
        f"REDUCTION {header.reduction:.12g}\n"
        f"ORIGINE_X {float(header.grid.origin_x)!r}\nORIGINE_Y {float(header.grid.origin_y)!r}\n"
        f"NB_CAMERA {header.cameras}\n"
    )


def _lines(camera: int, start: int, boxes: np.ndarray, visible: np.ndarray) -> bytes:
    """Lines of consecutive positions: one template for the block and one formatting of all its numbers."""
    numbers = np.empty((len(boxes), 5), dtype=np.int64)
    numbers[:, 0] = np.arange(start, start + len(boxes))
    numbers[:, 1:] = boxes
    used = np.ones(numbers.shape, dtype=bool)
    used[:, 1:] = visible[:, None]
    templates = (_NOT_VISIBLE.format(camera=camera), _VISIBLE.format(camera=camera))
    text = "".join([templates[seen] for seen in visible.tolist()])
    return (text % tuple(numbers[used].tolist())).encode()
