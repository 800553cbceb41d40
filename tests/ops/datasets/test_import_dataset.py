"""What an import of a sound folder leaves in the database and in the storage."""

from __future__ import annotations

import hashlib
import json
import shutil
from pathlib import Path

import pytest
from django.core.files.storage import default_storage

from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Annotation, Dataset, Frame, Image, Layer, LayerFrame, Save
from gtm_hit.ops.datasets.importing import ImportFailed, import_dataset
from gtm_hit.ops.files.images import storage_name
from gtm_hit.ops.frames import saving as annotation_ops
from gtm_hit.ops.frames.rules import checked
from gtm_hit.ops.ground.coverage import table as table_of
from tests.dataset_folder import (
    MATRIX,
    NAMES,
    PEOPLE,
    POSES,
    add_annotations,
    add_calibrations,
    add_images,
    make_folder,
    options,
    picture,
)
from tests.work_scene import as_sent

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_storage(settings: object, tmp_path: Path) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"  # type: ignore[attr-defined]
    settings.TABLES_ROOT = tmp_path / "tables"  # type: ignore[attr-defined]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return make_folder(tmp_path / "square")


def positions(layer: Layer) -> dict[int, dict[int, int]]:
    found: dict[int, dict[int, int]] = {}
    for number, person, position in Annotation.objects.filter(layer=layer).values_list(
        "frame__number", "person", "position"
    ):
        found.setdefault(number, {})[person] = position
    return found


def failure(folder: Path, **changes: object) -> list[str]:
    with pytest.raises(ImportFailed) as caught:
        import_dataset(options(folder, **changes))
    return [str(problem) for problem in caught.value.problems]


# First run


def test_cameras_are_those_of_the_files_in_metres(folder: Path) -> None:
    add_calibrations(folder, tvec_unit="cm")
    dataset = import_dataset(options(folder, tvec_unit="cm")).dataset
    for camera, pose in zip(dataset.calibrated_cameras(), POSES, strict=True):
        assert (camera.name, camera.width, camera.height) == (NAMES[camera.index], 320, 240)
        assert camera.tvec == pytest.approx(pose.tvec)
        assert camera.matrix.tolist() == MATRIX.tolist()


def test_every_frame_has_an_image_of_every_camera(folder: Path) -> None:
    import_dataset(options(folder))
    assert list(Frame.objects.values_list("number", flat=True)) == [0, 5]
    found = set(Image.objects.values_list("frame__number", "camera__name"))
    assert found == {(number, name) for number in (0, 5) for name in NAMES}


def test_derivatives_are_stored_under_the_digest_of_their_bytes(folder: Path) -> None:
    import_dataset(options(folder))
    for image in Image.objects.all():
        for digest, size in ((image.light_digest, image.light_bytes), (image.full_digest, image.full_bytes)):
            with default_storage.open(storage_name(digest)) as stream:
                data = stream.read()
            assert (hashlib.sha256(data).hexdigest(), len(data)) == (digest, size)


def test_an_image_remembers_the_file_it_was_made_from(folder: Path) -> None:
    import_dataset(options(folder))
    source = (folder / "Image_subsets/C2/00000005.png").read_bytes()
    image = Image.objects.get(camera__name="C2", frame__number=5)
    assert image.source_digest == hashlib.sha256(source).hexdigest()


def test_the_rectangle_table_of_the_dataset_is_there(folder: Path, tmp_path: Path) -> None:
    dataset = import_dataset(options(folder)).dataset
    table = RectangleTable.open(tmp_path / "tables" / f"rectangles-{table_of(dataset).digest}.bin")
    assert (table.cameras_count, table.grid) == (3, dataset.grid)


def test_annotations_go_into_a_layer_named_imported(folder: Path) -> None:
    import_dataset(options(folder))
    layer = Layer.objects.get()
    assert (layer.name, layer.kind, layer.hidden) == ("imported", Layer.Kind.IMPORTED, False)
    assert positions(layer) == PEOPLE
    assert set(Annotation.objects.values_list("state", "origin")) == {("validated", "imported")}


def test_every_imported_frame_is_done_with_one_save_of_what_is_there(folder: Path) -> None:
    import_dataset(options(folder))
    layer = Layer.objects.get()
    for frame in Frame.objects.all():
        head = LayerFrame.objects.get(layer=layer, frame=frame)
        assert (head.revision, head.done, head.nobody) == (1, True, False)
        now = annotation_ops.read_frame(layer, frame)
        assert annotation_ops.state_at(layer, frame, 1) == now


def test_what_is_imported_could_have_been_saved_by_hand(folder: Path) -> None:
    """Many rows are written at once, past the checks of single saves; these must find nothing to say."""
    dataset = import_dataset(options(folder)).dataset
    for save in Save.objects.all():
        rows, _seconds = checked(
            save.annotations, dataset.grid, done=save.done, nobody=save.nobody, seconds=save.seconds
        )
        assert as_sent(rows) == save.annotations


def test_imported_people_count_as_used_person_numbers(folder: Path) -> None:
    import_dataset(options(folder))
    assert Layer.objects.get().last_person == 9


def test_a_frame_annotated_as_empty_says_that_nobody_is_there(folder: Path) -> None:
    (folder / "annotations_positions/00000000.json").write_text("[]")
    import_dataset(options(folder))
    head = LayerFrame.objects.get(frame__number=0)
    assert (head.done, head.nobody, Save.objects.get(layer_frame=head).annotations) == (True, True, [])


def test_the_layer_may_have_another_name_and_be_hidden(folder: Path) -> None:
    import_dataset(options(folder, layer="gold", hidden_layer=True))
    layer = Layer.objects.get()
    assert (layer.name, layer.hidden) == ("gold", True)


def test_boxes_that_are_the_tables_are_not_worth_a_note(folder: Path) -> None:
    assert import_dataset(options(folder)).notes == []


def test_boxes_that_differ_are_counted_and_no_error(folder: Path) -> None:
    path = folder / "annotations_positions/00000000.json"
    people = json.loads(path.read_text())
    people[0]["views"][1]["xmin"] -= 1
    people[1]["views"][2].update(xmin=-1, ymin=-1, xmax=-1, ymax=-1)
    path.write_text(json.dumps(people))
    (note,) = import_dataset(options(folder)).notes
    assert note.startswith("2 of 15 boxes in the annotation files differ")


def test_a_persons_own_height_is_kept(folder: Path) -> None:
    path = folder / "annotations_positions/00000000.json"
    people = json.loads(path.read_text())
    people[0]["height"], people[1]["height"] = 1.4, 1.8
    path.write_text(json.dumps(people))
    import_dataset(options(folder))
    rows = Annotation.objects.filter(frame__number=0).values_list("person", "height")
    assert dict(rows) == {7: 1.4, 3: None}


def test_a_height_that_cannot_be_metres_is_ignored_with_a_note(folder: Path) -> None:
    path = folder / "annotations_positions/00000000.json"
    people = json.loads(path.read_text())
    people[0]["height"] = 180
    path.write_text(json.dumps(people))
    assert import_dataset(options(folder)).notes == [
        "height or radius of 1 people is not in metres and was ignored"
    ]


def test_a_dataset_without_annotations_gets_no_layer(folder: Path) -> None:
    shutil.rmtree(folder / "annotations_positions")
    assert import_dataset(options(folder)).layer is None
    assert not Layer.objects.exists()


def test_cameras_may_have_different_sizes(folder: Path) -> None:
    for number in (0, 5):
        (folder / f"Image_subsets/C2/{number:08d}.png").write_bytes(picture(number, 400, 300))
    shutil.rmtree(folder / "annotations_positions")
    dataset = import_dataset(options(folder)).dataset
    sizes = [(camera.width, camera.height) for camera in dataset.cameras.all()]
    assert sizes == [(320, 240), (400, 300), (320, 240)]


def test_frames_between_the_steps_are_left_out_with_a_note(folder: Path) -> None:
    add_images(folder, [3, 10])
    report = import_dataset(options(folder))
    assert list(Frame.objects.values_list("number", flat=True)) == [0, 5, 10]
    assert report.notes == ["1 frame lies between every 5th and was left out (--keep-all-frames takes them)"]


def test_all_frames_may_be_kept(folder: Path) -> None:
    add_images(folder, [3])
    import_dataset(options(folder, keep_all_frames=True))
    assert list(Frame.objects.values_list("number", flat=True)) == [0, 3, 5]


def test_an_annotated_frame_between_the_steps_is_kept(folder: Path) -> None:
    add_images(folder, [3])
    add_annotations(folder, {3: {7: 1220}})
    import_dataset(options(folder))
    assert list(Frame.objects.values_list("number", flat=True)) == [0, 3, 5]


def test_annotation_digits_are_taken_from_the_files(folder: Path) -> None:
    for path in (folder / "annotations_positions").iterdir():
        path.rename(path.with_stem(path.stem[-5:]))
    assert import_dataset(options(folder)).dataset.annotation_name(5) == "00005.json"


def test_progress_reaches_the_end_of_every_phase(folder: Path) -> None:
    last: dict[str, tuple[int, int]] = {}
    import_dataset(options(folder), lambda phase, done, total: last.update({phase: (done, total)}))
    assert last["making images"] == (6, 6)
    assert last["reading annotations"] == (2, 2)
    assert all(done == total for done, total in last.values())


# Second run


def test_a_second_run_adds_nothing(folder: Path) -> None:
    import_dataset(options(folder))
    before = [Frame.objects.count(), Image.objects.count(), Save.objects.count(), Annotation.objects.count()]
    report = import_dataset(options(folder))
    assert (report.frames_added, report.annotated_frames_added) == (0, 0)
    after = [Frame.objects.count(), Image.objects.count(), Save.objects.count(), Annotation.objects.count()]
    assert after == before


def test_a_second_run_adds_only_new_frames_and_annotations(folder: Path) -> None:
    import_dataset(options(folder))
    add_images(folder, [10])
    add_annotations(folder, {10: {11: 2000}})
    report = import_dataset(options(folder))
    assert (report.frames_added, report.images_added, report.annotated_frames_added) == (1, 3, 1)
    assert positions(Layer.objects.get()) == {**PEOPLE, 10: {11: 2000}}


def test_annotations_of_known_frames_may_come_later(folder: Path) -> None:
    kept = folder / "annotations_positions/00000005.json"
    data = kept.read_bytes()
    kept.unlink()
    import_dataset(options(folder))
    kept.write_bytes(data)
    report = import_dataset(options(folder))
    assert (report.frames_added, report.annotated_frames_added) == (0, 1)
    assert positions(Layer.objects.get()) == PEOPLE


def test_what_was_changed_in_the_layer_is_not_imported_again(folder: Path) -> None:
    import_dataset(options(folder))
    layer, frame = Layer.objects.get(), Frame.objects.get(number=0)
    row = {"person": 7, "position": 1300}
    save_id = "5f0f8f0e-9d0c-4b4e-8a60-7b1c6f3f1a11"
    annotation_ops.save_frame(layer, frame, None, save_id, 1, [row])  # type: ignore[arg-type]
    import_dataset(options(folder))
    assert positions(layer)[0] == {7: 1300}


def test_a_second_layer_takes_the_same_annotations(folder: Path) -> None:
    import_dataset(options(folder))
    import_dataset(options(folder, layer="second"))
    assert [positions(layer) for layer in Layer.objects.all()] == [PEOPLE, PEOPLE]


def test_a_second_run_needs_no_options_again(folder: Path) -> None:
    import_dataset(options(folder))
    add_images(folder, [10])
    assert import_dataset(options(folder, values={})).frames_added == 1


def test_another_calibration_is_told_and_nothing_added(folder: Path) -> None:
    import_dataset(options(folder))
    add_images(folder, [10])
    path = folder / "calibrations/intrinsic_zero/intr_C2.xml"
    path.write_text(path.read_text().replace("300.0", "301.0"))
    assert failure(folder) == ["camera C2: the dataset was imported with another calibration (matrix differ)"]
    assert Frame.objects.count() == 2


def test_a_forgotten_unit_is_told_by_comparing_with_the_first_run(folder: Path) -> None:
    import_dataset(options(folder))
    problems = failure(folder, tvec_unit="cm")
    assert len(problems) == 3
    assert all(problem.endswith("tvec looks like metres, use --tvec-unit m") for problem in problems)


def test_another_grid_is_told(folder: Path) -> None:
    import_dataset(options(folder))
    assert failure(folder, values={"step": 0.05}) == ["options: step is 0.1 in dataset square, not 0.05"]


def test_undistortion_must_be_as_in_the_first_run(folder: Path) -> None:
    import_dataset(options(folder))
    assert failure(folder, undistort=True) == [
        "options: the images of dataset square were imported without --undistort"
    ]


def test_an_image_that_changed_since_is_told(folder: Path) -> None:
    import_dataset(options(folder))
    (folder / "Image_subsets/C1/00000005.png").write_bytes(picture(99))
    assert failure(folder) == [
        "Image_subsets/C1/00000005.png: differs from the image this frame was imported with"
    ]


def test_annotations_never_go_into_somebody_elses_layer(folder: Path) -> None:
    dataset = import_dataset(options(folder)).dataset
    Layer.objects.create(dataset=dataset, name="work", kind=Layer.Kind.ASSIGNMENT)
    (problem,) = failure(folder, layer="work")
    assert problem.startswith("options: layer work is a worker's assignment")


def test_a_failed_second_run_keeps_the_pictures_of_the_first(folder: Path) -> None:
    import_dataset(options(folder))
    # The same pictures under a new number, and one that is broken.
    for name in NAMES:
        data = (folder / f"Image_subsets/{name}/00000000.png").read_bytes()
        (folder / f"Image_subsets/{name}/00000010.png").write_bytes(data[: -2000 if name == "C3" else None])
    assert len(failure(folder)) == 1
    for image in Image.objects.all():
        assert default_storage.exists(storage_name(image.light_digest))
        assert default_storage.exists(storage_name(image.full_digest))


def test_two_datasets_may_share_their_pictures(folder: Path) -> None:
    import_dataset(options(folder))
    import_dataset(options(folder, slug="again"))
    assert Dataset.objects.count() == 2
    assert len(set(Image.objects.values_list("light_digest", flat=True))) == 6
