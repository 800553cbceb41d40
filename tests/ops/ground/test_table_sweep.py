from __future__ import annotations

import io
import os
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from django.core.management import call_command
from django.utils import timezone

from gtm_hit.models import Dataset, Job
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration.replacing import preview, replace_calibration
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.exports import expiry
from gtm_hit.ops.ground import table_sweep
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.jobs import queue
from tests.dataset_folder import make_folder, options
from tests.ops.calibration.test_replace_calibration import no_progress, shifted

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_folders(settings: Any, tmp_path: Path) -> None:
    for name in ("MEDIA", "TABLES", "EXPORTS", "UPLOADS"):
        setattr(settings, f"{name}_ROOT", tmp_path / name.lower())


@pytest.fixture
def dataset(tmp_path: Path) -> Dataset:
    return import_dataset(options(make_folder(tmp_path / "square"))).dataset


def tables(tmp_path: Path) -> list[Path]:
    return sorted((tmp_path / "tables").glob("rectangles-*"))


def age(tmp_path: Path, by: timedelta) -> None:
    then = (timezone.now() - by).timestamp()
    for path in tables(tmp_path):
        os.utime(path, (then, then))


OLD = table_sweep.GRACE + timedelta(hours=1)


def placed(dataset: Dataset, pixels: float = 7.0) -> Path:
    """The table of a calibration that is put in place now."""
    replace_calibration(dataset, shifted(pixels), preview(dataset, shifted(pixels), no_progress))
    return table(Dataset.objects.get(pk=dataset.pk)).path


def test_a_comparison_leaves_no_table_behind(dataset: Dataset, tmp_path: Path) -> None:
    before = tables(tmp_path)
    job = calibration_job.start(dataset, shifted())
    queue.run(job.pk, {Job.Kind.REPLACE_CALIBRATION: calibration_job.run})
    job.refresh_from_db()
    assert job.state == Job.State.DONE and job.result["cameras"][1]["max"] == 7
    assert tables(tmp_path) == before == [table(dataset).path]


def test_tables_that_are_in_use_no_longer_go_and_the_one_in_use_stays(
    dataset: Dataset, tmp_path: Path
) -> None:
    *_gone, kept = [placed(dataset, pixels) for pixels in (1.0, 2.0, 3.0)]
    age(tmp_path, OLD)
    assert len(tables(tmp_path)) == 4
    expiry.expire(timezone.now())
    assert tables(tmp_path) == [kept]


def test_a_new_table_has_its_time(dataset: Dataset, tmp_path: Path) -> None:
    placed(dataset)
    age(tmp_path, table_sweep.GRACE - timedelta(hours=1))
    assert table_sweep.sweep(timezone.now()) == 0
    assert len(tables(tmp_path)) == 2


@pytest.mark.django_db(transaction=True)
def test_what_is_put_in_place_has_its_table_at_once(dataset: Dataset, tmp_path: Path) -> None:
    replace_calibration(dataset, shifted(), preview(dataset, shifted(), no_progress))
    there = tables(tmp_path)
    assert len(there) == 2 and table(Dataset.objects.get(pk=dataset.pk)).path in there


def test_the_table_of_a_replaced_calibration_goes(dataset: Dataset, tmp_path: Path) -> None:
    before = table(dataset).path
    job = calibration_job.start(dataset, shifted())
    queue.run(job.pk, {Job.Kind.REPLACE_CALIBRATION: calibration_job.run})
    calibration_job.confirm(job)
    after = table(dataset).path
    age(tmp_path, OLD)
    assert table_sweep.sweep(timezone.now()) == 1
    assert not before.exists() and tables(tmp_path) == [after]


def test_tables_go_though_exports_are_kept_for_ever(dataset: Dataset, tmp_path: Path, settings: Any) -> None:
    settings.EXPORT_KEEP_DAYS = 0
    placed(dataset)
    age(tmp_path, OLD)
    call_command("cleanup", stdout=io.StringIO())
    assert len(tables(tmp_path)) == 1


def test_without_any_table_there_is_nothing_to_do() -> None:
    assert table_sweep.sweep(timezone.now()) == 0
