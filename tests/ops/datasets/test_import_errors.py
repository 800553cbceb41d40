"""Everything that can be wrong with a dataset's folder is told with its file; nothing is imported then."""

from __future__ import annotations

import errno
import json
import zlib
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path

import pytest
from django.apps import apps
from django.core.files.storage import default_storage
from django.utils import timezone

from gtm_hit.models import Dataset, Frame
from gtm_hit.ops.datasets.importing import ImportFailed, import_dataset
from gtm_hit.ops.files.picture_cleanup import remove_unused_pictures
from tests.dataset_folder import GRID, add_calibrations, make_folder, options, picture

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_storage(settings: object, tmp_path: Path) -> Path:
    settings.MEDIA_ROOT = tmp_path / "media"  # type: ignore[attr-defined]
    settings.TABLES_ROOT = tmp_path / "tables"  # type: ignore[attr-defined]
    return tmp_path / "media"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return make_folder(tmp_path / "square")


def problems_of(folder: Path, **changes: object) -> list[str]:
    """The problems of an import that must fail; nothing at all may be left of it."""
    with pytest.raises(ImportFailed) as caught:
        import_dataset(options(folder, **changes))
    for model in apps.get_app_config("gtm_hit").get_models():
        assert not model._default_manager.exists(), f"{model.__name__} has rows"
    assert stored_files() == []
    return [str(problem) for problem in caught.value.problems]


def stored_files() -> list[str]:
    """What is left when the clock has cleaned up, a day later: until then another import may count on it."""
    remove_unused_pictures(timezone.now() + timedelta(days=1, minutes=1))
    root = Path(default_storage.path(""))
    return [str(path) for path in root.rglob("*") if path.is_file()]


def edit_json(folder: Path, change: Callable[[list[dict]], object]) -> None:
    path = folder / "annotations_positions" / "00000000.json"
    people = json.loads(path.read_text())
    change(people)
    path.write_text(json.dumps(people))


def replace_in(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


# Images


def test_a_truncated_image_is_told(folder: Path) -> None:
    path = folder / "Image_subsets/C2/00000005.png"
    path.write_bytes(path.read_bytes()[:-2000])
    (problem,) = problems_of(folder)
    assert problem.startswith("Image_subsets/C2/00000005.png: damaged or truncated")


def test_an_image_with_one_wrong_byte_is_told(folder: Path) -> None:
    path = folder / "Image_subsets/C1/00000000.png"
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0x55
    path.write_bytes(data)
    (problem,) = problems_of(folder)
    assert problem.startswith("Image_subsets/C1/00000000.png: damaged or truncated")


def test_a_text_named_png_is_told(folder: Path) -> None:
    (folder / "Image_subsets/C3/00000000.png").write_text("no image")
    assert problems_of(folder) == ["Image_subsets/C3/00000000.png: neither a PNG nor a JPEG"]


def test_an_empty_image_is_told(folder: Path) -> None:
    (folder / "Image_subsets/C3/00000000.png").write_bytes(b"")
    assert problems_of(folder) == ["Image_subsets/C3/00000000.png: the file is empty"]


def test_an_image_of_another_size_than_its_camera_is_told(folder: Path) -> None:
    (folder / "Image_subsets/C1/00000010.png").write_bytes(picture(1))
    for name in ("C2", "C3"):
        (folder / f"Image_subsets/{name}/00000010.png").write_bytes(picture(2))
    (folder / "Image_subsets/C1/00000000.png").write_bytes(picture(3, 640, 480))
    assert problems_of(folder) == ["Image_subsets/C1/00000000.png: 640×480 pixels, but camera C1 has 320×240"]


def test_an_image_that_claims_a_billion_pixels_is_refused_before_it_is_decoded(folder: Path) -> None:
    path = folder / "Image_subsets/C1/00000000.png"
    data = bytearray(path.read_bytes())
    data[16:24] = (40_000).to_bytes(4) * 2
    data[29:33] = zlib.crc32(data[12:29]).to_bytes(4)
    path.write_bytes(data)
    assert problems_of(folder) == ["Image_subsets/C1/00000000.png: more than 100000000 pixels"]


# Layout


def test_a_missing_camera_is_told(folder: Path) -> None:
    (folder / "calibrations/extrinsic/extr_C2.xml").unlink()
    assert "calibrations/extrinsic: no file for camera C2" in problems_of(folder)


def test_different_frame_sets_per_camera_are_told(folder: Path) -> None:
    (folder / "Image_subsets/C2/00000005.png").unlink()
    assert problems_of(folder) == ["camera C2: no image of 1 frames other cameras have: 5"]


def test_an_image_that_links_out_of_the_folder_is_refused(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "private.png").write_bytes(picture(1))
    path = folder / "Image_subsets/C1/00000000.png"
    path.unlink()
    path.symlink_to(tmp_path / "private.png")
    assert "Image_subsets/C1/00000000.png: leads out of the dataset folder" in problems_of(folder)


def test_a_folder_that_is_not_there_is_told(tmp_path: Path) -> None:
    assert problems_of(tmp_path / "nowhere") == [f"options: no such folder: {tmp_path / 'nowhere'}"]


def test_an_annotation_of_a_frame_without_images_is_told(folder: Path) -> None:
    (folder / "annotations_positions/00000777.json").write_text("[]")
    assert problems_of(folder) == ["annotations_positions/00000777.json: no images of frame 777"]


# Calibrations


def test_a_singular_camera_matrix_is_told(folder: Path) -> None:
    path = folder / "calibrations/intrinsic_zero/intr_C2.xml"
    replace_in(path, "0.0 300.0 120.0", "0.0 0.0 120.0")
    (problem,) = problems_of(folder)
    assert problem.startswith("calibrations/intrinsic_zero/intr_C2.xml: camera_matrix")


def test_a_pose_with_nan_is_told(folder: Path) -> None:
    path = folder / "calibrations/extrinsic/extr_C3.xml"
    first = path.read_text().split("<tvec", 1)[1].split("<data>")[1].split()[0]
    replace_in(path, first, ".Nan")
    (problem,) = problems_of(folder)
    assert problem.startswith("calibrations/extrinsic/extr_C3.xml: tvec: value 1 is not finite")


def test_centimetres_taken_for_metres_are_told_with_the_option_to_use(folder: Path) -> None:
    add_calibrations(folder, tvec_unit="cm")
    (problem,) = problems_of(folder)
    assert problem.endswith("tvec looks like centimetres: use --tvec-unit cm")


def test_metres_taken_for_centimetres_are_told_with_the_option_to_use(folder: Path) -> None:
    (problem,) = problems_of(folder, tvec_unit="cm")
    assert problem.endswith("tvec looks like metres: use --tvec-unit m")


def test_millimetres_taken_for_metres_are_told_with_the_option_to_use(folder: Path) -> None:
    add_calibrations(folder, tvec_unit="mm")
    (problem,) = problems_of(folder)
    assert problem.endswith("tvec looks like millimetres: use --tvec-unit mm")


def test_a_grid_no_camera_sees_is_told(folder: Path) -> None:
    (folder / "annotations_positions/00000005.json").unlink()
    edit_json(folder, lambda people: people.clear())
    values = {**options(folder).values, "origin_x": 60.0, "columns": 4, "rows": 4}
    assert problems_of(folder, values=values) == [
        "calibrations: no camera sees any position: grid, origin or --tvec-unit is wrong"
    ]


# Annotations


def test_an_empty_annotation_file_is_told(folder: Path) -> None:
    (folder / "annotations_positions/00000005.json").write_bytes(b"")
    assert problems_of(folder) == ["annotations_positions/00000005.json: the file is empty"]


def test_a_position_outside_the_grid_is_told(folder: Path) -> None:
    edit_json(folder, lambda people: people[1].update(positionID=GRID.count))
    (problem,) = problems_of(folder)
    assert problem.startswith("annotations_positions/00000000.json: entry 1: positionID is 4800")


def test_a_person_twice_in_a_frame_is_told(folder: Path) -> None:
    edit_json(folder, lambda people: people[1].update(personID=people[0]["personID"]))
    (problem,) = problems_of(folder)
    assert problem == "annotations_positions/00000000.json: entry 1: person 7 is already in entry 0"


def test_nan_in_an_annotation_is_told(folder: Path) -> None:
    edit_json(folder, lambda people: people[0].update(positionID=float("nan")))
    (problem,) = problems_of(folder)
    assert problem.startswith("annotations_positions/00000000.json: not JSON that can be read")


def test_boxes_of_too_few_cameras_are_told(folder: Path) -> None:
    edit_json(folder, lambda people: people[0]["views"].pop())
    (problem,) = problems_of(folder)
    assert problem.startswith("annotations_positions/00000000.json: entry 0")


def test_more_people_than_fit_in_a_frame_are_told(folder: Path) -> None:
    def crowd(people: list[dict]) -> None:
        people[:] = [{**people[0], "personID": person} for person in range(501)]

    edit_json(folder, crowd)
    assert problems_of(folder) == [
        "annotations_positions/00000000.json: 501 people; at most 500 fit in a frame"
    ]


# Options


def test_what_nobody_knows_is_asked_for(folder: Path) -> None:
    (problem,) = problems_of(folder, values={})
    assert problem == (
        "options: not known: --grid COLUMNSxROWS, --step METRES, --origin X,Y, "
        "--frame-rate NUMBERS_PER_SECOND; or choose a --preset"
    )


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("columns", 0),
        ("rows", 10**7),
        ("step", 0.0),
        ("step", 1e-300),
        ("step", 1e300),
        ("origin_y", 1e300),
        ("cylinder_radius", 1e-300),
        ("frame_rate", 1e-320),
        ("frame_rate", float("inf")),
        ("step", float("nan")),
        ("step", float("inf")),
        ("origin_x", float("inf")),
        ("cylinder_height", -1.0),
        ("frame_rate", 0.0),
        ("frame_step", 0),
        ("annotation_digits", 100),
    ],
)
def test_a_value_that_cannot_be_is_refused(folder: Path, name: str, value: float) -> None:
    problems = problems_of(folder, values={**options(folder).values, name: value})
    assert all(problem.startswith("options: ") for problem in problems)


@pytest.mark.parametrize("slug", ["", "two words", "../up", "ä", "x" * 81])
def test_a_slug_that_cannot_stand_in_an_address_is_refused(folder: Path, slug: str) -> None:
    assert problems_of(folder, slug=slug)[0].startswith("options: slug: ")


def test_a_layer_name_with_a_slash_is_refused(folder: Path) -> None:
    (problem,) = problems_of(folder, layer="../truth")
    assert problem.startswith("options: layer: ")


# Together


def test_all_errors_of_a_run_are_told_together(folder: Path) -> None:
    path = folder / "Image_subsets/C2/00000005.png"
    path.write_bytes(path.read_bytes()[:-2000])
    (folder / "annotations_positions/00000005.json").write_bytes(b"")
    (folder / "calibrations/extrinsic/extr_C1.xml").write_text("<opencv_storage/>")
    (folder / "Image_subsets/C3/nonumber.png").write_bytes(picture(1))
    files = {problem.split(": ")[0] for problem in problems_of(folder)}
    assert files == {
        "Image_subsets/C2/00000005.png",
        "annotations_positions/00000005.json",
        "calibrations/extrinsic/extr_C1.xml",
        "Image_subsets/C3/nonumber.png",
    }


def test_a_broken_image_at_the_end_leaves_no_derivatives_behind(folder: Path) -> None:
    path = folder / "Image_subsets/C3/00000005.png"
    path.write_bytes(path.read_bytes()[:-2000])
    assert len(problems_of(folder)) == 1


# Interrupted


def test_an_interrupted_import_leaves_nothing(folder: Path) -> None:
    def interrupt(phase: str, done: int, total: int) -> None:
        if phase == "making images" and done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        import_dataset(options(folder), interrupt)
    assert not Dataset.objects.exists()
    assert stored_files() == []


def test_of_two_imports_at_once_the_second_is_told_to_run_again(folder: Path) -> None:
    def somebody_else_was_faster(phase: str, done: int, total: int) -> None:
        if phase == "writing to the database" and done == 0:
            Dataset.objects.create(slug="square", name="Theirs")

    with pytest.raises(ImportFailed, match="square: was changed by another import in the meantime"):
        import_dataset(options(folder), somebody_else_was_faster)
    assert Dataset.objects.get().name == "Theirs"
    assert not Frame.objects.exists()
    assert stored_files() == []


def test_a_full_disk_is_told_and_leaves_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, data: bytes) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr("gtm_hit.ops.files.images.write_bytes", full)
    (problem,) = problems_of(folder)
    assert problem.endswith("No space left on device")
