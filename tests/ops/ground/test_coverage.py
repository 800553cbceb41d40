from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from gtm_hit.models import Dataset
from gtm_hit.ops.ground import coverage
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def tables(tmp_path: Path, settings: Any) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def dataset() -> Dataset:
    make_dataset(frames=1)
    Dataset.objects.update(columns=900, rows=600, step=0.05, origin_x=-20)
    return Dataset.objects.get()


def seen(dataset: Dataset) -> np.ndarray:
    """(rows, columns) number of cameras."""
    table = coverage.table(dataset)
    count = sum(table.visible(camera).astype(int) for camera in range(2))
    return np.reshape(count, (dataset.rows, dataset.columns))


def darkness(picture: bytes) -> np.ndarray:
    return 255 - np.asarray(Image.open(io.BytesIO(picture)).convert("L")).astype(int)


def test_every_position_is_counted_once(dataset: Dataset) -> None:
    found = coverage.coverage(dataset)
    expected = np.bincount(seen(dataset).ravel(), minlength=3).tolist()
    assert found.counts == expected
    assert sum(found.counts) == 900 * 600
    assert found.mean == pytest.approx(seen(dataset).mean())


def test_the_picture_is_darker_where_more_cameras_see(dataset: Dataset) -> None:
    dark = darkness(coverage.coverage(dataset).picture)
    cameras = np.flipud(seen(dataset))
    assert dark.shape == (600, 900)
    assert dark[cameras == 0].max() == 0
    assert dark[cameras == 1].min() > dark[cameras == 0].max()
    assert dark[cameras == 2].min() > dark[cameras == 1].max()


def test_a_grid_longer_along_y_is_turned_so_that_y_runs_to_the_right(dataset: Dataset) -> None:
    Dataset.objects.update(columns=200, rows=300)
    dataset = Dataset.objects.get()
    dark = darkness(coverage.coverage(dataset).picture)
    assert dark.shape == (200, 300)
    assert ((dark > 0) == (seen(dataset).T > 0)).all()


def test_shades_grow_darker_with_every_camera() -> None:
    brightness = [sum(coverage.shade(cameras, 12)) for cameras in range(13)]
    assert brightness == sorted(brightness, reverse=True)
    assert len(set(brightness)) == 13


def test_one_camera_alone_has_a_shade_too() -> None:
    assert coverage.shade(1, 1) != coverage.shade(0, 1)
