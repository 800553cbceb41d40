from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gtm_hit.models import Dataset, Layer
from tests.ops.exports.scene import MIDDLE, save
from tests.work_scene import make_dataset, make_layer


@pytest.fixture
def dataset(db: None) -> Dataset:
    return make_dataset(frames=4)


@pytest.fixture
def layer(dataset: Dataset) -> Layer:
    layer = make_layer(dataset)
    save(layer, 0, [(7, MIDDLE, {}), (2, MIDDLE + 40, {"origin": "carried", "state": "carried"})])
    save(layer, 10, [])
    return layer


@pytest.fixture
def exports(tmp_path: Path, settings: Any) -> Path:
    settings.EXPORTS_ROOT = tmp_path / "exports"
    settings.TABLES_ROOT = tmp_path / "tables"
    return settings.EXPORTS_ROOT
