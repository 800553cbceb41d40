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
from gtm_hit.ops.calibration.replacing import preview
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


def test_tables_of_previews_nobody_wanted_go_and_the_one_in_use_stays(
    dataset: Dataset, tmp_path: Path
) -> None:
    for pixels in (1.0, 2.0, 3.0):
        preview(dataset, shifted(pixels), no_progress)
    age(tmp_path, OLD)
    assert len(tables(tmp_path)) == 4
    expiry.expire(timezone.now())
    assert tables(tmp_path) == [table(dataset).path]


def test_a_new_table_has_its_time(dataset: Dataset, tmp_path: Path) -> None:
    preview(dataset, shifted(), no_progress)
    age(tmp_path, table_sweep.GRACE - timedelta(hours=1))
    assert table_sweep.sweep(timezone.now()) == 0
    assert len(tables(tmp_path)) == 2


def test_a_comparison_that_may_be_confirmed_keeps_its_table(dataset: Dataset, tmp_path: Path) -> None:
    job = calibration_job.start(dataset, shifted())
    queue.run(job.pk, {Job.Kind.REPLACE_CALIBRATION: calibration_job.run})
    age(tmp_path, OLD)
    assert table_sweep.sweep(timezone.now()) == 0
    Job.objects.update(finished_at=timezone.now() - OLD)
    assert table_sweep.sweep(timezone.now()) == 1


def test_the_table_of_a_replaced_calibration_goes(dataset: Dataset, tmp_path: Path) -> None:
    before = table(dataset).path
    job = calibration_job.start(dataset, shifted())
    queue.run(job.pk, {Job.Kind.REPLACE_CALIBRATION: calibration_job.run})
    calibration_job.confirm(job)
    age(tmp_path, OLD)
    assert table_sweep.sweep(timezone.now()) == 1
    assert not before.exists() and tables(tmp_path) == [table(dataset).path]


def test_tables_go_though_exports_are_kept_for_ever(dataset: Dataset, tmp_path: Path, settings: Any) -> None:
    settings.EXPORT_KEEP_DAYS = 0
    preview(dataset, shifted(), no_progress)
    age(tmp_path, OLD)
    call_command("cleanup", stdout=io.StringIO())
    assert len(tables(tmp_path)) == 1


def test_without_any_table_there_is_nothing_to_do() -> None:
    assert table_sweep.sweep(timezone.now()) == 0
