from __future__ import annotations

import json
import zipfile
from collections.abc import Callable, Iterator
from io import StringIO
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.formats.annotations.wildtrack_json import read_frame
from gtm_hit.formats.calibration.wildtrack_xml import read_extrinsic, read_intrinsic
from gtm_hit.formats.manifest import verify
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.models import Annotation, Dataset, Frame, Job, Layer, LayerFrame
from gtm_hit.ops.exports import exporting, frames
from gtm_hit.ops.exports.calibrations import published_names
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.jobs import queue
from tests.disk_events import recorded
from tests.work_scene import make_dataset, make_layer

pytestmark = pytest.mark.django_db

MIDDLE = 200 * 400 + 200  # the position at (0, 0) metres, seen by both cameras


@pytest.fixture
def dataset() -> Dataset:
    return make_dataset(frames=4)


@pytest.fixture
def layer(dataset: Dataset) -> Layer:
    layer = make_layer(dataset)
    save(layer, 0, [(7, MIDDLE, {}), (2, MIDDLE + 40, {"origin": "carried", "state": "carried"})])
    save(layer, 10, [])
    return layer


@pytest.fixture(autouse=True)
def exports(tmp_path: Path, settings: Any) -> Path:
    settings.EXPORTS_ROOT = tmp_path / "exports"
    settings.TABLES_ROOT = tmp_path / "tables"
    return settings.EXPORTS_ROOT


def save(layer: Layer, number: int, people: list[tuple[int, int, dict[str, Any]]], revision: int = 1) -> None:
    frame = Frame.objects.get(dataset=layer.dataset, number=number)
    LayerFrame.objects.create(layer=layer, frame=frame, revision=revision)
    for person, position, values in people:
        Annotation.objects.create(layer=layer, frame=frame, person=person, position=position, **values)


def export(layer: Layer, folder: Path, report: exporting.Report = lambda *_: None) -> Path:
    exporting.export_layer(layer, folder, folder.with_name("partial"), report)
    return folder


def people(folder: Path, number: int) -> list[dict[str, Any]]:
    return json.loads((folder / "annotations_positions" / f"{number:08d}.json").read_bytes())


def run_job(layer: Layer) -> Job:
    job = exporting.start(layer)
    queue.run(job.pk, {Job.Kind.EXPORT_LAYER: exporting.run})
    job.refresh_from_db()
    return job


def test_only_frames_that_were_saved_become_files(layer: Layer, tmp_path: Path) -> None:
    save(layer, 5, [], revision=0)
    folder = export(layer, tmp_path / "out")
    names = sorted(path.name for path in (folder / "annotations_positions").iterdir())
    assert names == ["00000000.json", "00000010.json"]
    assert people(folder, 10) == []


def test_frames_with_nobody_are_empty_lists(dataset: Dataset, tmp_path: Path) -> None:
    layer = make_layer(dataset)
    save(layer, 0, [])
    save(layer, 5, [])
    folder = export(layer, tmp_path / "out")
    assert [people(folder, number) for number in (0, 5)] == [[], []]


def test_a_person_has_the_published_keys_first_and_the_tables_rectangles(
    layer: Layer, tmp_path: Path
) -> None:
    folder = export(layer, tmp_path / "out")
    carried, clicked = people(folder, 0)
    assert list(clicked) == ["personID", "positionID", "views", "x", "y", "origin"]
    assert (clicked["personID"], clicked["positionID"], clicked["x"], clicked["y"]) == (7, MIDDLE, 0.0, 0.0)
    assert (clicked["origin"], carried["origin"], carried["validated"]) == ("clicked", "carried", False)
    dataset = layer.dataset
    for view, camera in zip(clicked["views"], dataset.calibrated_cameras(), strict=True):
        boxes, visible = rectangles(camera, dataset.grid, dataset.cylinder, dataset.rule, np.array([MIDDLE]))
        expected = boxes[0].tolist() if visible[0] else [-1] * 4
        assert [view[key] for key in ("xmin", "ymin", "xmax", "ymax")] == expected
    assert any(view["xmin"] != -1 for view in clicked["views"])


def test_a_person_of_another_size_has_rectangles_of_that_size(layer: Layer, tmp_path: Path) -> None:
    save(layer, 5, [(1, MIDDLE, {"height": 1.2}), (2, MIDDLE, {"radius": 0.3}), (3, MIDDLE, {})])
    small, wide, usual = people(export(layer, tmp_path / "out"), 5)
    assert (small["height"], wide["radius"]) == (1.2, 0.3)
    assert "height" not in usual and "radius" not in usual
    dataset = layer.dataset
    for person, size in ((small, Cylinder(0.16, 1.2)), (wide, Cylinder(0.3, 1.8)), (usual, dataset.cylinder)):
        for view, camera in zip(person["views"], dataset.calibrated_cameras(), strict=True):
            boxes, visible = rectangles(camera, dataset.grid, size, dataset.rule, np.array([MIDDLE]))
            expected = boxes[0].tolist() if visible[0] else [-1] * 4
            assert [view[key] for key in ("xmin", "ymin", "xmax", "ymax")] == expected


def test_the_files_are_read_back_without_a_problem(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    frame = read_frame(folder / "annotations_positions" / "00000000.json", layer.dataset.grid, 2)
    assert [(each.person, each.position) for each in frame.people] == [(2, MIDDLE + 40), (7, MIDDLE)]


def test_names_follow_the_datasets_offset_and_digits(layer: Layer, tmp_path: Path) -> None:
    Dataset.objects.update(annotation_offset=1, annotation_digits=5)
    layer = Layer.objects.get(pk=layer.pk)
    folder = export(layer, tmp_path / "out")
    assert (folder / "annotations_positions" / "00011.json").is_file()


def test_the_manifest_names_every_file_and_counts(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    assert verify(folder) == []
    manifest = json.loads((folder / "manifest.json").read_bytes())
    assert manifest["counts"] == {
        "frames": 2,
        "cameras": 2,
        "people": 2,
        "annotations": 2,
        "not_validated": 1,
    }
    assert manifest["parameters"]["grid"]["columns"] == 400
    assert {"README.txt", "cameras.json", "annotations_positions/00000000.json"} <= set(manifest["files"])


def test_exporting_twice_gives_the_same_bytes(layer: Layer, tmp_path: Path) -> None:
    first, second = export(layer, tmp_path / "first"), export(layer, tmp_path / "second")
    files = [path.relative_to(first) for path in first.rglob("*") if path.is_file()]
    assert all((first / name).read_bytes() == (second / name).read_bytes() for name in files)
    assert (tmp_path / "first.zip").read_bytes() == (tmp_path / "second.zip").read_bytes()


def test_the_zip_holds_the_folder_under_the_layers_name(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    with zipfile.ZipFile(tmp_path / "out.zip") as archive:
        names = archive.namelist()
        assert archive.read("square-own/manifest.json") == (folder / "manifest.json").read_bytes()
    assert sorted(names) == sorted(
        f"square-own/{path.relative_to(folder).as_posix()}" for path in folder.rglob("*") if path.is_file()
    )


def test_multiviewx_comes_out_as_it_was_published(shared_data: Path, tmp_path: Path) -> None:
    published = shared_data / "multiviewx"
    dataset = Dataset.objects.create(
        slug="multiviewx",
        name="MultiviewX",
        columns=1000,
        rows=640,
        origin_x=0,
        origin_y=0,
        foot_rule=FootRule.CENTRE.value,
        annotation_offset=1,
        annotation_digits=5,
    )
    for index in range(6):
        lens = read_intrinsic(published / "calibrations" / "intrinsic" / f"intr_Camera{index + 1}.xml")
        pose = read_extrinsic(published / "calibrations" / "extrinsic" / f"extr_Camera{index + 1}.xml")
        dataset.cameras.create(
            index=index,
            name=f"C{index + 1}",
            width=1920,
            height=1080,
            matrix=lens.matrix.tolist(),
            distortion=lens.distortion.tolist(),
            rvec=pose.rvec.tolist(),
            tvec=pose.tvec.tolist(),
        )
    layer = make_layer(dataset)
    sources = sorted((published / "annotations_positions").iterdir())
    for number, source in enumerate(sources):
        dataset.frames.create(number=number)
        people_there = read_frame(source, dataset.grid, 6).people
        save(layer, number, [(each.person, each.position, {}) for each in people_there])

    folder = export(layer, tmp_path / "out") / "annotations_positions"

    assert [path.name for path in sorted(folder.iterdir())] == [path.name for path in sources]
    for source in sources:
        expected = {each["personID"]: each for each in json.loads(source.read_bytes())}
        found = {each["personID"]: each for each in json.loads((folder / source.name).read_bytes())}
        assert found.keys() == expected.keys()
        for person, each in expected.items():
            assert {key: found[person][key] for key in each} == each


def test_wildtracks_calibration_is_bare_text_in_centimetres(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out") / "calibrations"
    camera = layer.dataset.calibrated_cameras()[0]
    text = (folder / "extrinsic" / "extr_C1.xml").read_text()
    assert "opencv-matrix" not in text
    pose = read_extrinsic(folder / "extrinsic" / "extr_C1.xml").in_metres("cm")
    np.testing.assert_allclose(pose.tvec, camera.tvec, rtol=0, atol=1e-12)
    lens = read_intrinsic(folder / "intrinsic_zero" / "intr_C1.xml")
    np.testing.assert_array_equal(lens.matrix, camera.matrix)


def test_multiviewx_calibration_is_read_by_opencv_in_metres(layer: Layer, tmp_path: Path) -> None:
    Dataset.objects.update(foot_rule=FootRule.CENTRE.value)
    layer.dataset.cameras.update(distortion=[0.01, 0, 0, 0, 0])
    layer = Layer.objects.get(pk=layer.pk)
    folder = export(layer, tmp_path / "out") / "calibrations"
    storage = cv2.FileStorage(str(folder / "extrinsic" / "extr_Camera1.xml"), cv2.FILE_STORAGE_READ)
    assert storage.getNode("tvec").mat().ravel().tolist() == [0.0, 1.0, 12.0]
    storage = cv2.FileStorage(str(folder / "intrinsic" / "intr_Camera1.xml"), cv2.FILE_STORAGE_READ)
    assert storage.getNode("distortion_coefficients").mat().ravel().tolist() == [0.01, 0, 0, 0, 0]


def test_seven_cameras_named_by_folder_get_the_names_readers_look_for(dataset: Dataset) -> None:
    camera = dataset.calibrated_cameras()[0]

    def named(*names: str) -> list[Any]:
        return [type(camera)(**{**vars(camera), "name": name}) for name in names]

    seven = named(*(f"C{number}" for number in range(1, 8)))
    assert published_names(seven, FootRule.CORNERS)[::6] == ["CVLab1", "IDIAP3"]
    assert published_names(seven[:2], FootRule.CORNERS) == ["C1", "C2"]
    assert published_names(named("lobby", "stairs"), FootRule.CENTRE) == ["lobby", "stairs"]


def test_a_long_layer_is_read_in_chunks_with_two_queries_each(
    dataset: Dataset, monkeypatch: pytest.MonkeyPatch, django_assert_num_queries: Callable[..., Any]
) -> None:
    monkeypatch.setattr(frames, "FRAMES_PER_CHUNK", 2)
    layer = make_layer(dataset)
    for number in (0, 5, 10):
        save(layer, number, [(1, MIDDLE + number, {})])
    reader = frames.FrameReader(layer, dataset, dataset.calibrated_cameras(), table(dataset))
    with django_assert_num_queries(5):
        chunks = list(reader)
    assert [chunk.numbers for chunk in chunks] == [[0, 5], [10]]
    assert [chunk.positions.tolist() for chunk in chunks] == [[MIDDLE, MIDDLE + 5], [MIDDLE + 10]]


def test_nothing_is_left_when_it_fails(layer: Layer, tmp_path: Path) -> None:
    def fail(phase: str, done: int, total: int) -> None:
        if (phase, done) == (exporting.FRAMES, total):
            raise OSError("disk full")

    with pytest.raises(OSError):
        export(layer, tmp_path / "out", fail)
    assert [path.name for path in tmp_path.iterdir()] == ["tables"]


def test_a_failure_leaves_the_earlier_export_as_it_was(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    before = (folder / "manifest.json").read_bytes(), (tmp_path / "out.zip").read_bytes()
    save(layer, 5, [(1, MIDDLE, {})])

    def lost() -> None:
        raise queue.JobLost("somebody else has it")

    with pytest.raises(queue.JobLost):
        exporting.export_layer(layer, folder, tmp_path / "partial", lambda *_: None, lost)
    assert before == ((folder / "manifest.json").read_bytes(), (tmp_path / "out.zip").read_bytes())


@pytest.mark.parametrize("name", ["out", "out.zip"])
def test_a_rename_that_fails_leaves_the_earlier_export_as_it_was(
    layer: Layer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    folder = export(layer, tmp_path / "out")
    before = (folder / "manifest.json").read_bytes(), (tmp_path / "out.zip").read_bytes()
    save(layer, 5, [(1, MIDDLE, {})])
    replace = Path.replace

    def failing(path: Path, target: Path) -> Path:
        if target == tmp_path / name and path.name.startswith("content"):
            raise OSError("no space for a longer folder")
        return replace(path, target)

    monkeypatch.setattr(Path, "replace", failing)
    with pytest.raises(OSError):
        exporting.export_layer(layer, folder, tmp_path / "partial", lambda *_: None)
    assert before == ((folder / "manifest.json").read_bytes(), (tmp_path / "out.zip").read_bytes())
    assert not (tmp_path / "partial").exists()


def test_an_export_is_on_the_disk_before_it_gets_its_name(
    layer: Layer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    events = recorded(monkeypatch)
    folder = export(layer, tmp_path / "out")
    named = events.index(("rename", folder))
    synced = {path.name for kind, path in events[:named] if kind == "sync"}
    assert synced >= {path.name for path in folder.rglob("*")}
    assert events[-1] == ("sync", tmp_path)


def test_an_earlier_export_is_replaced_whole(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    LayerFrame.objects.filter(frame__number=10).delete()
    export(layer, folder)
    assert verify(folder) == []
    assert not (folder / "annotations_positions" / "00000010.json").exists()


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


@pytest.fixture
def three_partials(exports: Path, dataset: Dataset) -> Iterator[dict[str, Path]]:
    running = Job.objects.create(kind=Job.Kind.EXPORT_LAYER, dataset=dataset, state="running", attempts=2)
    names = {
        "alive": f"square-own-{running.pk}.partial-{running.pk}-2",
        "lost": f"square-own-{running.pk}.partial-{running.pk}-1",
        "gone": "square-own-999.partial-999-1",
        "other": "a-folder.partially-mine",
    }
    folders = {key: exports / name for key, name in names.items()}
    for folder in folders.values():
        (folder / "content").mkdir(parents=True)
    yield folders


def test_only_unfinished_work_of_dead_attempts_is_removed(three_partials: dict[str, Path]) -> None:
    exporting.remove_dead_partials()
    there = {key for key, folder in three_partials.items() if folder.exists()}
    assert there == {"alive", "other"}


def command(name: str, *arguments: Any) -> str:
    out = StringIO()
    call_command(name, *arguments, stdout=out, stderr=StringIO())
    return out.getvalue()


def test_the_command_writes_the_same_files_as_a_job(layer: Layer, tmp_path: Path) -> None:
    out = command("exportlayer", "square", "own", tmp_path / "by-hand")
    assert "2 frames, 2 annotations" in out
    done = exporting.finished(run_job(layer))
    assert done is not None
    assert (tmp_path / "by-hand.zip").read_bytes() == done.archive.read_bytes()


def test_the_command_refuses_a_folder_with_other_things_in_it(layer: Layer, tmp_path: Path) -> None:
    folder = tmp_path / "thesis"
    folder.mkdir()
    (folder / "chapter.tex").write_text("years of work")
    with pytest.raises(CommandError, match="holds no export"):
        command("exportlayer", "square", "own", folder)
    assert [path.name for path in folder.iterdir()] == ["chapter.tex"]


def test_the_command_takes_an_empty_folder_and_an_earlier_export(layer: Layer, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    command("exportlayer", "square", "own", folder)
    command("exportlayer", "square", "own", folder)
    assert verify(folder) == []


def test_the_command_names_the_layers_there_are(layer: Layer, tmp_path: Path) -> None:
    with pytest.raises(CommandError, match="there are: own"):
        command("exportlayer", "square", "onw", tmp_path / "out")


def test_the_pom_file_has_a_line_per_camera_and_position(tmp_path: Path) -> None:
    dataset = make_dataset(frames=1)
    Dataset.objects.update(columns=20, rows=30)
    command("exportpom", dataset.slug, tmp_path / "rectangles.pom")
    lines = (tmp_path / "rectangles.pom").read_text().splitlines()
    assert sum(line.startswith("RECTANGLE ") for line in lines) == 2 * 20 * 30
    assert "NB_WIDTH 20" in lines and "NB_HEIGHT 30" in lines
    with pytest.raises(CommandError, match="there are: square"):
        command("exportpom", "circle", tmp_path / "circle.pom")
