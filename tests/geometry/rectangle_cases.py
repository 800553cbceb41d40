"""Makes fixtures/rectangle_cases.json, which the tests of Python and of the browser both read.

    python -m tests.geometry.rectangle_cases

What is expected comes from the slow reference rule, not from the code under test.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict

import numpy as np

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule
from gtm_hit.geometry.grid import Grid
from tests.geometry.reference_rule import reference_rectangles
from tests.geometry.scenes import (
    FIXTURES,
    WILDTRACK_GRID,
    enlarged,
    mirrored,
    mirrored_grid,
    wildtrack_cameras,
)

PATH = FIXTURES / "rectangle_cases.json"
CYLINDERS_PER_CAMERA = 6
POSITIONS_PER_CYLINDER = 12
UNEVEN_GRID = Grid(columns=113, rows=257, step=0.11, origin_x=-3.3, origin_y=-8.7)


def _scenes() -> Iterator[tuple[Camera, Grid]]:
    for camera in wildtrack_cameras():
        yield camera, WILDTRACK_GRID
    for camera in wildtrack_cameras(original=True)[::2]:
        yield camera, UNEVEN_GRID
    for camera in wildtrack_cameras()[::3]:
        yield mirrored(camera), mirrored_grid(WILDTRACK_GRID)
    yield enlarged(wildtrack_cameras()[0]), WILDTRACK_GRID


def _cases(rng: np.random.Generator) -> Iterator[dict]:
    for camera, grid in _scenes():
        for number in range(CYLINDERS_PER_CAMERA):
            rule = list(FootRule)[number % 2]
            cylinder = Cylinder(float(rng.uniform(0.1, 0.3)), float(rng.uniform(1.2, 2.1)))
            positions = rng.integers(0, grid.count, POSITIONS_PER_CYLINDER)
            boxes = reference_rectangles(camera, grid, cylinder, rule, positions)
            yield {
                "camera": camera.as_json(),
                "grid": {
                    "columns": grid.columns,
                    "rows": grid.rows,
                    "step": grid.step,
                    "origin": [grid.origin_x, grid.origin_y],
                },
                "cylinder": asdict(cylinder),
                "rule": rule.value,
                "positions": positions.tolist(),
                "rectangles": [box if any(box) else None for box in boxes.tolist()],
            }


def main() -> None:
    cases = list(_cases(np.random.default_rng(20170509)))
    lines = ",\n".join(json.dumps(case) for case in cases)
    PATH.write_text(f"[\n{lines}\n]\n", encoding="utf-8")


if __name__ == "__main__":
    main()
