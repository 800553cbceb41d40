from __future__ import annotations

import importlib
import io
import json
import uuid
from pathlib import Path
from typing import Any

import pytest
from django.apps import apps
from django.core.management import CommandError, call_command

from gtm_hit import migrations
from gtm_hit.formats.calibration.cameras_json import load_cameras, save_cameras
from gtm_hit.models import AppendOnlyError, Calibration, Dataset, Frame, Job, Layer, Release, Save
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.calibration.replacing import preview, replace_calibration
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.frames import saving
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.releases import releasing
from tests.dataset_folder import cameras, make_folder, options
from tests.ops.calibration.test_replace_calibration import calibrations, no_progress, shifted
from tests.work_scene import row

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_folders(settings: Any, tmp_path: Path) -> None:
    for name in ("MEDIA", "TABLES", "EXPORTS", "RELEASES"):
        setattr(settings, f"{name}_ROOT", tmp_path / name.lower())


@pytest.fixture
def dataset(tmp_path: Path) -> Dataset:
    return import_dataset(options(make_folder(tmp_path / "square"))).dataset


def put(dataset: Dataset, new: list, source: str = "new.json") -> int:
    number = replace_calibration(dataset, new, preview(dataset, new, no_progress), source).number
    dataset.refresh_from_db()
    return number


def matrices(number: int) -> list[list[float]]:
    found = versions.cameras_in(Calibration.objects.get(number=number))
    return [camera.matrix.ravel().tolist() for camera in found]


def save(dataset: Dataset) -> Save:
    layer, _ = Layer.objects.get_or_create(dataset=dataset, name="own", kind=Layer.Kind.STAFF)
    head = layer.layer_frames.first()
    frame = Frame.objects.filter(dataset=dataset).order_by("number")[0]
    saving.save_frame(layer, frame, None, uuid.uuid4(), head.revision if head else 0, [row(1, 100)])
    newest = Save.objects.filter(layer_frame__layer=layer).order_by("-revision").first()
    assert newest is not None
    return newest


def test_an_import_keeps_its_calibration_under_number_one(dataset: Dataset) -> None:
    version = dataset.calibration
    assert (version.number, version.source, version.dataset) == (1, "import", dataset)
    assert matrices(1) == calibrations(dataset)
    assert set(Save.objects.values_list("calibration__number", flat=True)) == {1}


def test_what_is_replaced_stays_under_its_number(dataset: Dataset) -> None:
    old = calibrations(dataset)
    assert put(dataset, shifted()) == 2
    assert (matrices(1), matrices(2)) == (old, calibrations(dataset)) and old != calibrations(dataset)
    assert dataset.calibration.number == 2 and dataset.calibration.source == "new.json"


def test_a_calibration_that_was_there_before_gets_its_number_back(dataset: Dataset) -> None:
    old = calibrations(dataset)
    put(dataset, shifted())
    assert put(dataset, versions.cameras_in(versions.version(dataset, 1))) == 1
    assert calibrations(dataset) == old and dataset.calibration.number == 1
    assert Calibration.objects.count() == 2


def test_a_version_never_changes(dataset: Dataset) -> None:
    version = versions.version(dataset, 1)
    version.source = "elsewhere"
    with pytest.raises(AppendOnlyError):
        version.save()


def test_saves_say_under_which_calibration_they_were_made(dataset: Dataset) -> None:
    first = save(dataset)
    put(dataset, shifted())
    second = save(dataset)
    assert (first.calibration.number, second.calibration.number) == (1, 2)
    told = saving.history(first.layer_frame.layer, first.layer_frame.frame)
    assert [revision.calibration for revision in told] == [1, 2]


def test_an_export_names_its_calibration(dataset: Dataset, tmp_path: Path) -> None:
    put(dataset, shifted())
    layer = Layer.objects.get(name="imported")
    manifest = exporting.export_layer(layer, tmp_path / "out", tmp_path / "partial", no_progress)
    assert manifest.parameters["calibration"] == 2
    assert load_cameras(tmp_path / "out" / "cameras.json")[1].matrix[0, 2] == 167


def test_an_export_has_one_calibration_though_it_is_replaced_meanwhile(
    dataset: Dataset, tmp_path: Path
) -> None:
    layer = Layer.objects.select_related("dataset").get(name="imported")
    seen = preview(dataset, shifted(), no_progress)

    def replaced(phase: str, _done: int, _total: int) -> None:
        if phase == "writing frames" and dataset.calibrations.count() == 1:
            replace_calibration(dataset, shifted(), seen)

    manifest = exporting.export_layer(layer, tmp_path / "out", tmp_path / "partial", replaced)
    assert dataset.calibrations.count() == 2 and manifest.parameters["calibration"] == 1
    assert load_cameras(tmp_path / "out" / "cameras.json")[1].matrix[0, 2] == 160


def test_a_release_names_its_calibration(dataset: Dataset, tmp_path: Path) -> None:
    put(dataset, shifted())
    order = releasing.Order(Layer.objects.get(name="imported"), "free")
    release = releasing.make_release(order, tmp_path / "partial", no_progress)
    assert release.calibration.number == release.manifest["parameters"]["calibration"] == 2


def test_a_release_is_refused_when_the_calibration_is_replaced_meanwhile(
    dataset: Dataset, tmp_path: Path
) -> None:
    seen = preview(dataset, shifted(), no_progress)

    def replaced(phase: str, _done: int, _total: int) -> None:
        if phase == releasing.MEASURING and dataset.calibrations.count() == 1:
            replace_calibration(dataset, shifted(), seen)

    order = releasing.Order(Layer.objects.get(name="imported"), "free")
    with pytest.raises(releasing.ReleaseError, match="calibration was replaced"):
        releasing.make_release(order, tmp_path / "partial", replaced)
    assert not Release.objects.exists()


def test_a_job_goes_back_to_an_earlier_version_when_it_is_confirmed(dataset: Dataset) -> None:
    old = calibrations(dataset)
    put(dataset, shifted())
    job = calibration_job.start_version(dataset, 1)
    queue.run(job.pk, {Job.Kind.REPLACE_CALIBRATION: calibration_job.run})
    assert calibrations(dataset) != old
    calibration_job.confirm(job)
    job.refresh_from_db()
    assert calibrations(dataset) == old and job.result["calibration"] == 1


def test_a_version_that_never_was_is_refused(dataset: Dataset) -> None:
    with pytest.raises(versions.UnknownVersion, match="square has no calibration 2"):
        calibration_job.start_version(dataset, 2)
    assert not Job.objects.exists()


def test_a_dataset_without_versions_keeps_what_was_in_place(dataset: Dataset) -> None:
    old = calibrations(dataset)
    forget_versions(dataset)
    assert put(dataset, shifted()) == 2
    assert matrices(1) == old


def test_datasets_of_before_get_their_first_version(dataset: Dataset) -> None:
    before = (dataset.calibration.digest, dataset.calibration.cameras)
    forget_versions(dataset)
    (name,) = (path.stem for path in Path(migrations.__path__[0]).glob("*_first_calibrations.py"))
    importlib.import_module(f"gtm_hit.migrations.{name}").keep_what_is_in_place(apps, None)
    dataset.refresh_from_db()
    assert (dataset.calibration.number, dataset.calibration.source) == (1, versions.NOT_KNOWN)
    assert (dataset.calibration.digest, dataset.calibration.cameras) == before


def forget_versions(dataset: Dataset) -> None:
    Save.objects.update(calibration=None)
    Dataset.objects.update(calibration=None)
    Calibration.objects.all().delete()
    dataset.refresh_from_db()


def test_a_dataset_is_deleted_with_its_versions(dataset: Dataset) -> None:
    save(dataset)
    dataset.delete()
    assert not Calibration.objects.exists()


# The command


def command(*words: str) -> str:
    out = io.StringIO()
    call_command("replacecalibration", "square", *words, stdout=out)
    return out.getvalue()


def test_the_command_lists_versions_and_marks_the_one_in_place(dataset: Dataset, tmp_path: Path) -> None:
    save_cameras(tmp_path / "new.json", shifted())
    assert "in place as number 2" in command(str(tmp_path / "new.json"), "--confirm")
    lines = [line.split() for line in command("--list").splitlines()]
    assert [(words[0], words[-1]) for words in lines] == [("*", "new.json"), ("1", "import")]


def test_the_command_goes_back_to_an_earlier_version(dataset: Dataset) -> None:
    put(dataset, shifted())
    assert "Nothing was changed" in command("--number", "1")
    assert calibrations(dataset)[1] == shifted()[1].matrix.ravel().tolist()
    assert "in place as number 1" in command("--number", "1", "--confirm")
    assert calibrations(dataset)[1] == cameras()[1].matrix.ravel().tolist()


@pytest.mark.parametrize("words", [[], ["new.json", "--number", "1"], ["--number", "9"]])
def test_the_command_wants_a_calibration_there_is(dataset: Dataset, words: list[str]) -> None:
    with pytest.raises(CommandError):
        command(*words)


def test_versions_hold_a_cameras_json(dataset: Dataset, tmp_path: Path) -> None:
    (tmp_path / "one.json").write_text(json.dumps(versions.version(dataset, 1).cameras))
    found = load_cameras(tmp_path / "one.json")
    assert [camera.matrix.ravel().tolist() for camera in found] == calibrations(dataset)
