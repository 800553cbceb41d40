"""Exports as jobs."""

from __future__ import annotations

from pathlib import Path

import pytest

from gtm_hit.models import Dataset, Job, Layer
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.jobs import queue
from tests.ops.exports.scene import run_job
from tests.work_scene import make_layer

pytestmark = [pytest.mark.django_db, pytest.mark.usefixtures("exports")]


def test_a_job_ends_with_files_to_download(layer: Layer, exports: Path) -> None:
    job = run_job(layer)
    assert job.state == Job.State.DONE, job.message
    assert (job.done, job.total, job.result["counts"]["frames"]) == (100, 100, 2)
    done = exporting.finished(job)
    assert done is not None
    assert done.archive_name == "square-own.zip"
    assert exporting.sha256(done.archive) == job.result["sha256"]
    assert sorted(path.name for path in exports.iterdir()) == [done.folder.name, done.archive.name]


def test_an_empty_layer_is_refused_in_plain_words(dataset: Dataset, exports: Path) -> None:
    job = run_job(make_layer(dataset, "empty"))
    assert (job.state, job.message) == (Job.State.FAILED, "Nothing has been saved in the layer empty yet.")
    assert list(exports.iterdir()) == []


def test_a_layer_deleted_meanwhile_fails_the_job_in_plain_words(layer: Layer) -> None:
    job = exporting.start(layer)
    layer.delete()
    queue.run(job.pk, {Job.Kind.EXPORT_LAYER: exporting.run})
    job.refresh_from_db()
    assert (job.state, job.message) == (Job.State.FAILED, "The layer is no longer there.")


def test_files_removed_from_the_disk_are_no_longer_offered(layer: Layer) -> None:
    job = run_job(layer)
    done = exporting.finished(job)
    assert done is not None
    done.archive.unlink()
    assert exporting.finished(job) is None
