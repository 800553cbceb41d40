"""jobs, progress and releases: what pages and REST tell, on the command line."""

from __future__ import annotations

import json
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.models import Dataset, Job, Layer
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.work import assignments, batches
from gtm_hit.tasks import OPERATIONS
from tests.ops.square_layer import fill, make_square
from tests.work_scene import make_layer, make_worker


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    for name in ("TABLES", "EXPORTS", "RELEASES"):
        setattr(settings, f"{name}_ROOT", tmp_path / name.lower())


@pytest.fixture
def truth(db: None) -> Layer:
    layer = make_layer(make_square(), "truth")
    fill(layer)
    return layer


def run(*arguments: str) -> str:
    output = StringIO()
    call_command(*arguments, stdout=output, stderr=StringIO())
    return output.getvalue()


def an_export(layer: Layer) -> Job:
    parameters = {"layer": layer.name, "layer_id": layer.pk, "formats": ["csv"]}
    return queue.create(Job.Kind.EXPORT_LAYER, layer.dataset, parameters)


def test_jobs_are_listed_the_newest_first_and_narrowed_down(truth: Layer) -> None:
    first, second = an_export(truth), queue.create(Job.Kind.IMPORT_DATASET, None, {})
    listed = [json.loads(line)["id"] for line in run("jobs", "--json").splitlines()]
    assert listed == [second.pk, first.pk]
    (line,) = run("jobs", "--dataset", "square", "--state", "queued").splitlines()
    assert line.split()[0] == str(first.pk) and "export_layer" in line
    assert run("jobs", "--state", "failed") == ""
    assert len(run("jobs", "--most", "1").splitlines()) == 1


def test_a_job_is_awaited_and_its_result_told(truth: Layer) -> None:
    job = an_export(truth)
    queue.run(job.pk, OPERATIONS)
    told = json.loads(run("jobs", str(job.pk), "--wait", "--json"))
    assert (told["state"], told["result"]["counts"]["annotations"] > 0) == ("done", True)


def test_waiting_for_a_job_that_fails_fails(truth: Layer) -> None:
    job = queue.create(Job.Kind.EXPORT_LAYER, truth.dataset, {"layer_id": 0})
    queue.run(job.pk, OPERATIONS)
    with pytest.raises(CommandError, match=f"job {job.pk}: failed"):
        run("jobs", str(job.pk), "--wait")


def test_a_job_is_stopped_and_done_again(truth: Layer) -> None:
    job = an_export(truth)
    with pytest.raises(CommandError, match="still under way"):
        run("jobs", str(job.pk), "--retry")
    assert "cancelled" in run("jobs", str(job.pk), "--cancel")
    again = json.loads(run("jobs", str(job.pk), "--retry", "--json"))
    assert (again["state"], again["id"] != job.pk) == ("queued", True)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("jobs", "99"), "no job 99"),
        (("jobs", "--cancel"), "say which job"),
        (("progress", "nowhere"), "no dataset nowhere"),
        (("releases", "nowhere"), "no dataset nowhere"),
        (("releases", "square", "4"), "no release 4"),
        (("releases", "square", "--print", "LICENSE"), "NUMBER"),
    ],
)
def test_what_is_not_there_is_told(truth: Layer, arguments: tuple[str, ...], said: str) -> None:
    with pytest.raises(CommandError, match=said):
        run(*arguments)


def test_progress_tells_who_has_what_by_pseudonym(truth: Layer) -> None:
    dataset = Dataset.objects.get()
    batches.make_batches(dataset, size=1)
    mine = assignments.claim(make_worker("ada-lovelace"), dataset)
    told = json.loads(run("progress", "square", "--json"))
    assert (told["leased"], told["batches"]) == (1, dataset.frames.count())
    assert [row["worker"] for row in told["assignments"]] == [mine.worker.pseudonym]
    said = run("progress", "square")
    assert f"{mine.worker.pseudonym}" in said and "lovelace" not in said
    assert len(run("progress", "square", "--state", "submitted").splitlines()) == 1


def test_releases_are_listed_and_their_files_printed(truth: Layer, tmp_path: Path) -> None:
    (tmp_path / "licence").write_text("Use it as you like.")
    run("makerelease", "square", "truth", "--licence", str(tmp_path / "licence"), "--title", "First")
    (line,) = run("releases", "square").splitlines()
    assert line.endswith("First")
    told = json.loads(run("releases", "square", "1", "--json"))
    assert (told["layer"], Path(told["archive"]).is_file()) == ("truth", True)
    assert run("releases", "square", "1", "--print", "LICENSE") == "Use it as you like.\n"
    manifest = json.loads(run("releases", "square", "1", "--print", "manifest.json"))
    assert manifest["counts"] == told["counts"]
