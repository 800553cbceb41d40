"""What a release holds, that it never changes, and that no worker can be told from it."""

from __future__ import annotations

import csv
import io
import json
import uuid
import zipfile
from pathlib import Path
from typing import Any

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.formats.manifest import verify
from gtm_hit.models import AppendOnlyError, Assignment, Dataset, Frame, Job, Layer, Release
from gtm_hit.ops.frames import saving
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.releases import releasing
from gtm_hit.ops.work import assignments, batches
from gtm_hit.tasks import OPERATIONS
from tests.disk_events import recorded
from tests.ops.square_layer import fill, make_square
from tests.work_scene import as_sent, finish, make_layer, make_worker, minutes_pass, row

pytestmark = pytest.mark.django_db

LICENCE = "Use it as you like."
REAL_ID = "A1REALWORKERID"


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.EXPORTS_ROOT = tmp_path / "exports"
    settings.RELEASES_ROOT = tmp_path / "releases"


@pytest.fixture
def dataset() -> Dataset:
    return make_square()


@pytest.fixture
def layer(dataset: Dataset) -> Layer:
    layer = make_layer(dataset, "truth", Layer.Kind.GROUND_TRUTH)
    fill(layer)
    return layer


def release(layer: Layer, **values: Any) -> Release:
    order = releasing.Order(layer, LICENCE, **values)
    made = releasing.make_release(order, releasing.settings.RELEASES_ROOT / "partial", lambda *_: None)
    return Release.objects.get(pk=made.pk)


def change(layer: Layer, number: int, rows: list[dict[str, Any]]) -> None:
    frame = Frame.objects.get(dataset=layer.dataset, number=number)
    state = saving.read_frame(layer, frame)
    saving.save_frame(layer, frame, None, uuid.uuid4(), state.revision, rows, done=True, nobody=not rows)


def rows_of(layer: Layer, number: int) -> list[dict[str, Any]]:
    frame = Frame.objects.get(dataset=layer.dataset, number=number)
    return as_sent(saving.read_frame(layer, frame).annotations)


def provenance(made: Release) -> list[dict[str, str]]:
    text = (releasing.folder_of(made) / "provenance.csv").read_text()
    return list(csv.DictReader(io.StringIO(text)))


def changes(made: Release) -> dict[str, Any]:
    return json.loads((releasing.folder_of(made) / "changes.json").read_text())


def test_a_release_holds_data_licence_provenance_changes_statistics_and_figures(layer: Layer) -> None:
    made = release(layer, title="First light")
    folder = releasing.folder_of(made)
    assert verify(folder) == []
    names = {path.relative_to(folder).parts[0] for path in folder.rglob("*") if path.is_file()}
    assert names >= {
        "LICENSE",
        "README.md",
        "annotations_positions",
        "changes.json",
        "coco",
        "figures",
        "manifest.json",
        "mot",
        "people.csv",
        "provenance.csv",
    }
    readme = (folder / "README.md").read_text()
    assert "# Square, release 1: First light" in readme
    assert "4 frames, 12 people, 36 annotations." in readme
    assert (folder / "LICENSE").read_text() == LICENCE + "\n"
    for line in readme.splitlines():
        if line.startswith("!["):
            assert (folder / line.partition("(")[2].rstrip(")")).read_text().startswith("<svg")


def test_the_zip_holds_the_same_files(layer: Layer) -> None:
    made = release(layer)
    folder = releasing.folder_of(made)
    with zipfile.ZipFile(releasing.archive_of(made)) as archive:
        inside = {name.partition("/")[2]: archive.read(name) for name in archive.namelist()}
    assert inside == {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()
    }


def test_releases_are_numbered_and_the_earlier_ones_stay_as_they_are(layer: Layer) -> None:
    first = release(layer)
    before = releasing.archive_of(first).read_bytes()
    change(layer, 0, [row(99, 1220)])
    second = release(layer)
    assert (first.number, second.number) == (1, 2)
    assert releasing.archive_of(first).read_bytes() == before
    assert verify(releasing.folder_of(first)) == []
    assert [each.number for each in releasing.releases(layer.dataset)] == [2, 1]


def test_a_release_cannot_be_changed(layer: Layer) -> None:
    made = release(layer)
    made.title = "another"
    with pytest.raises(AppendOnlyError):
        made.save()


def test_changes_name_people_added_removed_and_moved_in_metres(layer: Layer) -> None:
    first = release(layer)
    assert changes(first) == {
        "since": None,
        "frames": [],
        "counts": {"frames": 0, "added": 0, "removed": 0, "moved": 0},
    }
    old = rows_of(layer, 5)
    moved = {**old[1], "position": old[1]["position"] + 3}
    change(layer, 5, [moved, *old[2:], row(77, 1220)])
    change(layer, 15, [row(5, 100)])
    found = changes(release(layer))
    assert found["counts"] == {"frames": 2, "added": 2, "removed": 1, "moved": 1}
    assert found["since"] == 1
    five, fifteen = found["frames"]
    assert [each["person"] for each in five["added"]] == [77]
    assert [each["person"] for each in five["removed"]] == [old[0]["person"]]
    assert [(each["person"], each["metres"]) for each in five["moved"]] == [(old[1]["person"], 0.3)]
    assert (fifteen["frame"], [each["person"] for each in fifteen["added"]]) == (15, [5])


def test_a_workers_layer_is_released_under_the_pseudonym_alone(dataset: Dataset) -> None:
    batches.make_batches(dataset)
    worker = make_worker(REAL_ID)
    assignment = assignments.claim(worker, dataset)
    frame = Frame.objects.get(dataset=dataset, number=5)
    rows = [row(1, 1220), row(2, 2440, origin="interpolated")]
    minutes_pass(assignment)
    saving.save_frame(assignment.layer, frame, worker, uuid.uuid4(), 0, rows, done=True, seconds=30.0)
    made = release(assignment.layer)
    assert [(each["worker"], each["origin"], float(each["seconds"])) for each in provenance(made)] == [
        (worker.pseudonym, "clicked", 15.0),
        (worker.pseudonym, "interpolated", 15.0),
    ]


def test_the_real_id_of_no_worker_is_anywhere_in_a_release(dataset: Dataset, layer: Layer) -> None:
    made = release(accepted_truth(dataset, layer))
    folder, real = releasing.folder_of(made), REAL_ID.encode()
    files = [path for path in folder.rglob("*") if path.is_file()]
    assert not [path for path in files if real in path.read_bytes() or REAL_ID in str(path)]
    with zipfile.ZipFile(releasing.archive_of(made)) as archive:
        assert not [name for name in archive.namelist() if real in archive.read(name) or REAL_ID in name]
    assert REAL_ID not in json.dumps(made.manifest)


def accepted_truth(dataset: Dataset, layer: Layer) -> Layer:
    """The truth as staff made it, where a worker's accepted batch has the same people in frame 0."""
    batches.make_batches(dataset)
    worker = make_worker(REAL_ID)
    assignment = assignments.claim(worker, dataset)
    frame = Frame.objects.get(dataset=dataset, number=0)
    rows = [{**each, "person": index} for index, each in enumerate(rows_of(layer, 0), start=1)]
    minutes_pass(assignment)
    saving.save_frame(assignment.layer, frame, worker, uuid.uuid4(), 0, rows, done=True, seconds=24.0)
    finish(assignment)
    Assignment.objects.filter(pk=assignment.pk).update(state=Assignment.State.ACCEPTED)
    return layer


def test_ground_truth_names_the_worker_whose_accepted_annotation_it_is(
    dataset: Dataset, layer: Layer
) -> None:
    found = provenance(release(accepted_truth(dataset, layer)))
    worker = Assignment.objects.get().worker.pseudonym
    assert {(each["worker"], each["seconds"]) for each in found if each["frame"] == "0"} == {(worker, "2.0")}
    assert {each["worker"] for each in found if each["frame"] != "0"} == {""}


def test_an_empty_layer_is_not_released(dataset: Dataset, tmp_path: Path) -> None:
    with pytest.raises(releasing.ReleaseError, match="Nothing has been saved"):
        release(make_layer(dataset))
    assert not Release.objects.exists()
    assert not [path for path in (tmp_path / "releases").rglob("*") if path.is_file()]


def test_a_release_needs_a_licence(layer: Layer) -> None:
    with pytest.raises(releasing.ReleaseError, match="licence"):
        releasing.start(releasing.Order(layer, "  "))
    assert not Job.objects.exists()


def test_a_layer_that_changes_while_it_is_released_is_not(layer: Layer, tmp_path: Path) -> None:
    def meddle(phase: str, done: int, total: int) -> None:
        if phase == releasing.MEASURING and done == 1:
            change(layer, 0, [row(99, 1220)])

    with pytest.raises(releasing.ReleaseError, match="changed"):
        releasing.make_release(releasing.Order(layer, LICENCE), tmp_path / "partial", meddle)
    assert not Release.objects.exists()


def test_of_two_at_once_one_gets_the_number_and_the_other_is_told(layer: Layer, tmp_path: Path) -> None:
    def overtake() -> None:
        release(layer)

    with pytest.raises(releasing.ReleaseError, match="somebody else"):
        releasing.make_release(releasing.Order(layer, LICENCE), tmp_path / "other", lambda *_: None, overtake)
    assert [each.number for each in releasing.releases(layer.dataset)] == [1]
    assert verify(releasing.folder_of(Release.objects.get())) == []


def test_a_job_makes_a_release_once_however_often_it_is_taken_up(layer: Layer) -> None:
    job = releasing.start(releasing.Order(layer, LICENCE, "by job"))
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    assert (job.state, job.result["release"]) == (Job.State.DONE, 1)
    Job.objects.filter(pk=job.pk).update(state=Job.State.QUEUED)
    queue.run(job.pk, OPERATIONS)
    assert Release.objects.count() == 1


def test_a_failed_job_leaves_nothing(layer: Layer, tmp_path: Path) -> None:
    job = releasing.start(releasing.Order(layer, LICENCE))
    Layer.objects.filter(pk=layer.pk).delete()
    queue.run(job.pk, OPERATIONS)
    job.refresh_from_db()
    assert (job.state, job.message) == (Job.State.FAILED, "The layer is no longer there.")


def test_the_command_releases_and_says_where(layer: Layer, tmp_path: Path) -> None:
    licence = tmp_path / "licence.txt"
    licence.write_text(LICENCE)
    out = io.StringIO()
    words = ["makerelease", "square", "truth", "--licence", str(licence), "--title", "From the shell"]
    call_command(*words, "--format", "csv", stdout=out, stderr=out)
    made = Release.objects.get()
    assert made.title == "From the shell"
    assert made.manifest["parameters"]["formats"] == ["csv"]
    assert str(releasing.folder_of(made)) in out.getvalue()
    assert not (releasing.settings.RELEASES_ROOT / "square" / ".partial").exists()


def test_the_command_names_the_layers_there_are(layer: Layer, tmp_path: Path) -> None:
    with pytest.raises(CommandError, match="there are: truth"):
        call_command("makerelease", "square", "nothing", "--licence", str(tmp_path))


def test_a_releases_files_are_on_the_disk_before_its_row_is_there(
    layer: Layer, monkeypatch: pytest.MonkeyPatch
) -> None:
    events = recorded(monkeypatch)
    found = release(layer)
    folder = releasing.folder_of(found)
    named = events.index(("rename", folder))
    synced = {path.name for kind, path in events[:named] if kind == "sync"}
    assert synced >= {path.name for path in folder.rglob("*")}
    assert ("sync", folder.parent) in events[named:]
