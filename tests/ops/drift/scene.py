"""A dataset of three cameras, one of which is knocked in the middle of it."""

from __future__ import annotations

from pathlib import Path

import cv2

from gtm_hit.models import Dataset
from gtm_hit.ops.datasets.importing import import_dataset
from tests.calibration.drift.street import street
from tests.dataset_folder import HEIGHT, NAMES, WIDTH, make_folder, options

FRAMES = tuple(range(0, 60, 5))
KNOCKED, SINCE, BY = "C2", 40, (2.6, -1.5)


def knocked(root: Path) -> Dataset:
    folder = make_folder(root / "square")
    for index, name in enumerate(NAMES):
        for frame in FRAMES:
            dx, dy = BY if name == KNOCKED and frame >= SINCE else (0.0, 0.0)
            picture = street(dx, dy, people=1, seed=1000 * index + frame, size=(WIDTH, HEIGHT))
            cv2.imwrite(str(folder / "Image_subsets" / name / f"{frame:08d}.png"), picture)
    return import_dataset(options(folder)).dataset
