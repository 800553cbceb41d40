from __future__ import annotations

import pytest

from gtm_hit.models import Dataset
from gtm_hit.ops.work.batches import make_batches
from tests.work_scene import make_dataset


@pytest.fixture
def dataset(db: None) -> Dataset:
    dataset = make_dataset()
    make_batches(dataset)
    return dataset
