"""What the tests read POM files with; the format is described in `gtm_hit.formats.pom`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gtm_hit.formats.pom import PomHeader
from gtm_hit.geometry.cylinder import Cylinder
from gtm_hit.geometry.grid import Grid

_NAMES = (
    *("WIDTH", "HEIGHT", "NB_WIDTH", "NB_HEIGHT", "MAN_RAY", "MAN_HEIGHT"),
    *("REDUCTION", "ORIGINE_X", "ORIGINE_Y", "NB_CAMERA"),
)
_RECTANGLE = re.compile(r"RECTANGLE (\d+) (\d+) (?:notvisible|(-?\d+) (-?\d+) (-?\d+) (-?\d+))")


@dataclass(frozen=True, eq=False)
class PomFile:
    """A table read from text.

    boxes : (C, N, 4) int32, xmin ymin xmax ymax in pixels, 0 where not visible
    visible : (C, N) bool
    """

    header: PomHeader
    boxes: np.ndarray
    visible: np.ndarray


def read_pom(path: Path) -> PomFile:
    """A file with the whole header, then a line for every camera and position in order; no other."""
    lines = path.read_text().splitlines()
    header = _header(lines[: len(_NAMES)])
    count = header.grid.count
    boxes = np.zeros((header.cameras, count, 4), dtype=np.int32)
    visible = np.zeros((header.cameras, count), dtype=bool)
    rectangles = lines[len(_NAMES) :]
    assert len(rectangles) == header.cameras * count
    for number, line in enumerate(rectangles):
        match = _RECTANGLE.fullmatch(line)
        assert match, line
        place = divmod(number, count)
        assert (int(match[1]), int(match[2])) == place, line
        if match[3] is not None:
            visible[place] = True
            boxes[place] = [int(each) for each in match.groups()[2:]]
    return PomFile(header, boxes, visible)


def _header(lines: Sequence[str]) -> PomHeader:
    names, values = zip(*(line.split(" ") for line in lines), strict=True)
    assert names == _NAMES
    width, height, columns, rows, radius, tall, reduction, x, y, cameras = map(float, values)
    # A step of 0.1 comes back as such although 3 * 0.1 is not 0.3.
    step, upright = (float(f"{extent:.12g}") for extent in (width / columns, height / rows))
    assert step == upright
    grid = Grid(int(columns), int(rows), step, x, y)
    return PomHeader(grid, Cylinder(radius, tall), int(cameras), reduction)
