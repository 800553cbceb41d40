from __future__ import annotations

import io
import uuid
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from django.contrib.auth.models import User
from django.core.management import CommandError, call_command

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, rectangles
from gtm_hit.geometry.table import table_digest
from gtm_hit.models import Annotation, Dataset, Job, Layer
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration import replacing
from gtm_hit.ops.calibration.reading import read_replacement
from gtm_hit.ops.calibration.replacing import ReplacementError, preview, replace_calibration
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.frames import saving
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.jobs import queue
from tests.dataset_folder import NAMES, PEOPLE, add_calibrations, cameras, make_folder, options
from tests.work_scene import row

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_storage(settings: object, tmp_path: Path) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"  # type: ignore[attr-defined]
    settings.TABLES_ROOT = tmp_path / "tables"  # type: ignore[attr-defined]


@pytest.fixture
def dataset(tmp_path: Path) -> Dataset:
    return import_dataset(options(make_folder(tmp_path / "square"))).dataset


def no_progress(*_told: object) -> None:
    pass


def shifted(pixels: float = 7.0, camera: int = 1) -> list[Camera]:
    """One camera's image centre moved to the right: all its boxes go by that much."""
    found = cameras()
    matrix = found[camera].matrix.copy()
    matrix[0, 2] += pixels
    found[camera] = replace(found[camera], matrix=matrix)
    return found


def calibrations(dataset: Dataset) -> list[list[float]]:
    return [camera.matrix.ravel().tolist() for camera in dataset.calibrated_cameras()]


# What moves


def test_the_same_calibration_moves_nothing(dataset: Dataset) -> None:
    seen = preview(dataset, cameras(), no_progress)
    assert [each["moved"] for each in seen["cameras"]] == [0, 0, 0]
    assert seen["annotations"] == 5 and seen["worst"] == []


def test_only_the_boxes_of_the_camera_that_changed_move_and_by_its_change(dataset: Dataset) -> None:
    first, second, third = preview(dataset, shifted(7.0), no_progress)["cameras"]
    assert first["moved"] == third["moved"] == 0
    assert second["compared"] > 0 and second["moved"] == second["compared"]
    assert (second["median"], second["p95"], second["max"]) == (7, 7, 7)


def test_boxes_that_come_into_view_and_leave_it_are_counted(dataset: Dataset) -> None:
    new = shifted(400.0)
    positions = [position for people in PEOPLE.values() for position in people.values()]
    grid, size, rule = dataset.grid, dataset.cylinder, dataset.rule
    before = rectangles(cameras()[1], grid, size, rule, positions)[1]
    after = rectangles(new[1], grid, size, rule, positions)[1]
    there = preview(dataset, new, no_progress)["cameras"][1]
    back = preview_back(dataset, new)
    assert there["vanished"] == (before & ~after).sum() > 0
    assert back["appeared"] == there["vanished"] and back["vanished"] == there["appeared"]


def preview_back(dataset: Dataset, new: list[Camera]) -> dict:
    replace_calibration(dataset, new, preview(dataset, new, no_progress))
    return preview(Dataset.objects.get(pk=dataset.pk), cameras(), no_progress)["cameras"][1]


def test_the_worst_boxes_come_first_with_frame_person_and_view(dataset: Dataset) -> None:
    new = cameras()
    new[2] = replace(new[2], tvec=np.add(new[2].tvec, [0.1, 0.0, 0.3]))
    seen = preview(dataset, new, no_progress)
    shifts = [moved["shift"] for moved in seen["worst"]]
    assert shifts == sorted(shifts, reverse=True) and shifts[0] == seen["cameras"][2]["max"]
    for moved in seen["worst"]:
        position = PEOPLE[moved["frame"]][moved["person"]]
        box, _visible = rectangles(new[2], dataset.grid, dataset.cylinder, dataset.rule, [position])
        assert (moved["camera"], moved["layer"], moved["after"]) == (2, "imported", box[0].tolist())
        assert moved["shift"] == np.abs(np.subtract(moved["after"], moved["before"])).max()


def test_a_person_of_another_size_is_compared_by_its_own_boxes(dataset: Dataset) -> None:
    Annotation.objects.filter(person=7, frame__number=0).update(height=1.1)
    picture = preview(dataset, shifted(), no_progress)["picture"]
    assert picture["frame"] == 5
    Annotation.objects.exclude(person=7, frame__number=0).delete()
    picture = preview(dataset, shifted(), no_progress)["picture"]
    small, _visible = rectangles(
        cameras()[0], dataset.grid, Cylinder(0.16, 1.1), dataset.rule, [PEOPLE[0][7]]
    )
    assert picture["before"][0] == small.tolist()


def test_the_picture_has_a_lattice_where_nobody_is_annotated(dataset: Dataset) -> None:
    Layer.objects.all().delete()
    seen = preview(dataset, shifted(), no_progress)
    assert seen["annotations"] == 0
    assert seen["picture"]["layer"] is None and len(seen["picture"]["before"][1]) > 5
    assert len(seen["picture"]["images"]) == len(NAMES)


def test_a_preview_changes_nothing(dataset: Dataset) -> None:
    before = calibrations(dataset), dataset.calibration
    preview(dataset, shifted(), no_progress)
    dataset.refresh_from_db()
    assert (calibrations(dataset), dataset.calibration) == before


# Putting it in place


def test_positions_stay_and_cameras_and_table_change_together(dataset: Dataset) -> None:
    positions = list(Annotation.objects.values_list("pk", "position"))
    new = shifted()
    replace_calibration(dataset, new, preview(dataset, new, no_progress))
    dataset.refresh_from_db()
    assert list(Annotation.objects.values_list("pk", "position")) == positions
    assert calibrations(dataset) == [camera.matrix.ravel().tolist() for camera in new]
    expected = table_digest(new, dataset.grid, dataset.cylinder, dataset.rule)
    assert table(dataset).digest == expected


def test_images_stay_with_their_cameras(dataset: Dataset) -> None:
    before = list(dataset.cameras.values_list("pk", "name"))
    replace_calibration(dataset, shifted(), preview(dataset, shifted(), no_progress))
    assert list(dataset.cameras.values_list("pk", "name")) == before


def test_it_refuses_when_somebody_annotated_since(dataset: Dataset) -> None:
    seen = preview(dataset, shifted(), no_progress)
    layer = Layer.objects.create(dataset=dataset, name="own", kind=Layer.Kind.STAFF)
    save(layer, dataset)
    with pytest.raises(ReplacementError, match="have changed"):
        replace_calibration(dataset, shifted(), seen)
    assert calibrations(dataset) == [camera.matrix.ravel().tolist() for camera in cameras()]


def test_it_refuses_when_a_layer_was_removed_since(dataset: Dataset) -> None:
    seen = preview(dataset, shifted(), no_progress)
    Layer.objects.all().delete()
    with pytest.raises(ReplacementError):
        replace_calibration(dataset, shifted(), seen)


def test_it_refuses_when_the_calibration_was_replaced_since(dataset: Dataset) -> None:
    seen, other = preview(dataset, shifted(), no_progress), preview(dataset, shifted(3.0), no_progress)
    replace_calibration(dataset, shifted(3.0), other)
    with pytest.raises(ReplacementError):
        replace_calibration(dataset, shifted(), seen)


def save(layer: Layer, dataset: Dataset) -> None:
    user = User.objects.create_user("sam", is_superuser=True)
    saving.save_frame(layer, dataset.frames.get(number=0), user, uuid.uuid4(), 0, [row(1, 1220)])


# As a job


def test_a_job_compares_and_waits_for_a_confirmation(dataset: Dataset) -> None:
    job = calibration_job.start(dataset, shifted())
    queue.run(job.pk, {Job.Kind.REPLACE_CALIBRATION: calibration_job.run})
    job.refresh_from_db()
    assert job.state == Job.State.DONE and job.result["cameras"][1]["max"] == 7
    assert calibrations(dataset)[1] != shifted()[1].matrix.ravel().tolist()
    calibration_job.confirm(job)
    job.refresh_from_db()
    assert job.result["confirmed_at"]
    assert calibrations(dataset)[1] == shifted()[1].matrix.ravel().tolist()


def test_a_job_is_confirmed_once(dataset: Dataset) -> None:
    job = calibration_job.start(dataset, shifted())
    queue.run(job.pk, {Job.Kind.REPLACE_CALIBRATION: calibration_job.run})
    calibration_job.confirm(job)
    with pytest.raises(ReplacementError, match="before"):
        calibration_job.confirm(job)


def test_an_unfinished_job_cannot_be_confirmed(dataset: Dataset) -> None:
    job = calibration_job.start(dataset, shifted())
    with pytest.raises(ReplacementError, match="no finished comparison"):
        calibration_job.confirm(job)
    assert calibrations(dataset)[1] == cameras()[1].matrix.ravel().tolist()


# Reading


def failure(dataset: Dataset, path: Path) -> str:
    with pytest.raises(FormatError) as caught:
        read_replacement(dataset, path)
    return str(caught.value)


def test_json_and_folders_are_read(dataset: Dataset, tmp_path: Path) -> None:
    save_cameras(tmp_path / "new.json", shifted())
    assert read_replacement(dataset, tmp_path / "new.json")[1].matrix[0, 2] == 167
    add_calibrations(tmp_path / "whole", tvec_unit="cm")
    for path in (tmp_path / "whole", tmp_path / "whole" / "calibrations"):
        found = read_replacement(dataset, path, "cm")
        assert np.allclose([camera.tvec for camera in found], [camera.tvec for camera in cameras()])


def test_cameras_must_match_by_name_and_size(dataset: Dataset, tmp_path: Path) -> None:
    new = cameras()
    new[0] = replace(new[0], width=640)
    new[2] = replace(new[2], name="Roof")
    save_cameras(tmp_path / "new.json", new)
    told = failure(dataset, tmp_path / "new.json")
    assert "camera C1: 640×240 pixels, but the images have 320×240" in told
    assert "camera Roof: belongs to no camera" in told and "none is camera C3" in told


def test_a_camera_too_few_is_refused(dataset: Dataset, tmp_path: Path) -> None:
    save_cameras(tmp_path / "new.json", cameras()[:2])
    assert "none is camera C3" in failure(dataset, tmp_path / "new.json")


def test_lens_distortion_is_refused_where_images_have_none(dataset: Dataset, tmp_path: Path) -> None:
    Dataset.objects.update(undistorted=True)
    dataset.refresh_from_db()
    new = [replace(camera, distortion=np.array([-0.1, 0, 0, 0, 0])) for camera in cameras()]
    save_cameras(tmp_path / "new.json", new)
    assert "has lens distortion, but the lens was taken out" in failure(dataset, tmp_path / "new.json")


def test_a_wrong_unit_is_told(dataset: Dataset, tmp_path: Path) -> None:
    add_calibrations(tmp_path / "new", tvec_unit="cm")
    assert "tvec looks like centimetres" in failure(dataset, tmp_path / "new")


def test_what_is_no_calibration_is_refused(dataset: Dataset, tmp_path: Path) -> None:
    assert "no folder" in failure(dataset, tmp_path / "nothing")


# The command


def test_the_command_changes_nothing_without_confirmation(dataset: Dataset, tmp_path: Path) -> None:
    save_cameras(tmp_path / "new.json", shifted())
    out = io.StringIO()
    call_command("replacecalibration", "square", str(tmp_path / "new.json"), stdout=out)
    assert "Nothing was changed" in out.getvalue() and "C2" in out.getvalue()
    assert calibrations(dataset)[1] == cameras()[1].matrix.ravel().tolist()


def test_the_command_confirms(dataset: Dataset, tmp_path: Path) -> None:
    save_cameras(tmp_path / "new.json", shifted())
    call_command(
        "replacecalibration", "square", str(tmp_path / "new.json"), "--confirm", stdout=io.StringIO()
    )
    assert calibrations(dataset)[1] == shifted()[1].matrix.ravel().tolist()


def test_the_command_names_what_is_wrong(dataset: Dataset, tmp_path: Path) -> None:
    (tmp_path / "new.json").write_text("{}")
    with pytest.raises(CommandError, match="1 problem; nothing was changed"):
        call_command("replacecalibration", "square", str(tmp_path / "new.json"), stderr=io.StringIO())


def test_blocks_of_annotations_add_up(dataset: Dataset, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = preview(dataset, shifted(3.0), no_progress)
    monkeypatch.setattr(replacing, "PEOPLE_TOGETHER", 2)
    assert preview(dataset, shifted(3.0), no_progress) == whole
