from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Dataset
from gtm_hit.ops.datasets.importing import import_dataset
from tests.dataset_folder import make_folder, options


@pytest.fixture
def staff(db: None, client: Client, settings: Any, tmp_path: Path) -> Client:
    for name in ("MEDIA", "TABLES"):
        setattr(settings, f"{name}_ROOT", tmp_path / name.lower())
    import_dataset(options(make_folder(tmp_path / "square")))
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    client.raise_request_exception = False
    return client


@pytest.mark.parametrize(
    "values", [{"step": 1e-300}, {"step": 1e300}, {"step": 1e-12}, {"frame_rate": 1e-320}]
)
@pytest.mark.parametrize(
    "address",
    [
        "/datasets/square/statistics/",
        "/datasets/square/statistics/numbers.csv",
        "/datasets/square/statistics/coverage.svg",
        "/api/v1/datasets/square/layers/imported/statistics/",
        "/api/v1/datasets/square/layers/imported/statistics/speeds.svg",
        "/datasets/square/",
    ],
)
def test_a_scene_of_impossible_measures_is_told_and_no_error(
    staff: Client, address: str, values: dict[str, float]
) -> None:
    Dataset.objects.update(**values)
    response = staff.get(address)
    assert response.status_code < 500
