from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from gtm_hit.formats.calibration.files import match_names
from gtm_hit.formats.dataset_folder import natural_key
from gtm_hit.formats.layout import Layout, find_layout
from gtm_hit.formats.problems import FormatError, ProblemList

WILDTRACK = ["CVLab1", "CVLab2", "CVLab3", "CVLab4", "IDIAP1", "IDIAP2", "IDIAP3"]


def touch(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()
    return path


def make_dataset(
    root: Path, cameras: Iterable[str] = ("C1", "C2", "C3"), frames: Iterable[str] = ("00000000", "00000005")
) -> Path:
    for camera in cameras:
        for frame in frames:
            touch(root / "Image_subsets" / camera / f"{frame}.png")
        touch(root / "calibrations" / "extrinsic" / f"extr_{camera}.xml")
        touch(root / "calibrations" / "intrinsic_zero" / f"intr_{camera}.xml")
    for frame in frames:
        touch(root / "annotations_positions" / f"{frame}.json")
    return root


def layout_of(root: Path, **options: Any) -> Layout:
    problems = ProblemList(root)
    layout = find_layout(root, problems, **options)
    problems.raise_if_any()
    return layout


def frames_of(layout: Layout) -> tuple[int, ...]:
    return tuple(layout.images[layout.cameras[0]])


def problems_of(root: Path, **options: Any) -> list[str]:
    with pytest.raises(FormatError) as caught:
        layout_of(root, **options)
    return [str(problem) for problem in caught.value.relative_to(root).problems]


# Published datasets


def test_multiviewx_is_found_with_its_annotations_one_behind(shared_data: Path) -> None:
    layout = layout_of(shared_data / "multiviewx")
    assert layout.cameras == ("C1", "C2", "C3", "C4", "C5", "C6")
    assert list(layout.calibrations.names.values()) == [f"Camera{number}" for number in range(1, 7)]
    assert frames_of(layout) == tuple(range(10))
    assert layout.annotations[0].name == "00001.json"
    assert layout.calibrations.extrinsic["C6"].name == "extr_Camera6.xml"


def test_wildtrack_is_found_with_a_chosen_folder_of_images(shared_data: Path) -> None:
    layout = layout_of(shared_data / "wildtrack", images=Path("original_frames"))
    assert layout.cameras == tuple(f"C{number}" for number in range(1, 8))
    assert list(layout.calibrations.names.values()) == WILDTRACK
    assert layout.images["C7"][0].parts[-2:] == ("C7", "00000000.jpg")
    assert layout.calibrations.intrinsic["C5"].parts[-2:] == ("intrinsic_zero", "intr_IDIAP1.xml")
    assert layout.calibrations.intrinsic_original["C5"].parts[-2:] == (
        "intrinsic_original",
        "intr_IDIAP1.xml",
    )


# Ways a dataset may look


def test_files_are_given_by_camera_and_frame_number(tmp_path: Path) -> None:
    layout = layout_of(make_dataset(tmp_path))
    assert frames_of(layout) == (0, 5)
    assert layout.images["C2"][5] == tmp_path / "Image_subsets" / "C2" / "00000005.png"
    assert layout.annotations[5] == tmp_path / "annotations_positions" / "00000005.json"
    assert layout.annotation_offset == 0


def test_twelve_cameras_come_in_natural_order(tmp_path: Path) -> None:
    names = [f"C{number}" for number in range(1, 13)]
    assert layout_of(make_dataset(tmp_path, reversed(names))).cameras == tuple(names)


def test_a_folder_with_one_image_per_camera_is_one_frame(tmp_path: Path) -> None:
    make_dataset(tmp_path, frames=())
    for camera in ("C1", "C2", "C3"):
        touch(tmp_path / "photos" / f"{camera}.jpg")
    layout = layout_of(tmp_path, images=Path("photos"))
    assert frames_of(layout) == (0,)
    assert layout.images["C3"][0].name == "C3.jpg"


def test_images_may_be_chosen_outside_the_dataset(tmp_path: Path) -> None:
    make_dataset(tmp_path / "set", frames=())
    for camera in ("C1", "C2", "C3"):
        touch(tmp_path / "disk" / camera / "7.png")
    assert frames_of(layout_of(tmp_path / "set", images=tmp_path / "disk")) == (7,)


def test_one_calibration_file_may_hold_both_parts(tmp_path: Path) -> None:
    for camera in ("A", "B"):
        touch(tmp_path / "images" / camera / "1.png")
        touch(tmp_path / "calibrations" / f"{camera}.yml")
    layout = layout_of(tmp_path)
    assert layout.calibrations.extrinsic == layout.calibrations.intrinsic
    assert layout.calibrations.extrinsic["B"].name == "B.yml"


def test_both_parts_may_lie_in_one_folder(tmp_path: Path) -> None:
    touch(tmp_path / "images" / "A" / "1.png")
    touch(tmp_path / "calibrations" / "extr_A.xml")
    touch(tmp_path / "calibrations" / "intr_A.xml")
    layout = layout_of(tmp_path)
    assert (layout.calibrations.extrinsic["A"].name, layout.calibrations.intrinsic["A"].name) == (
        "extr_A.xml",
        "intr_A.xml",
    )


def test_frame_numbers_may_follow_other_words(tmp_path: Path) -> None:
    make_dataset(tmp_path, frames=["frame_0012"])
    assert frames_of(layout_of(tmp_path)) == (12,)


def test_hidden_files_and_other_kinds_are_passed_over(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    for name in (".DS_Store", "._00000000.png", "notes.txt", "@eaDir/x.png"):
        touch(tmp_path / "Image_subsets" / "C1" / name)
    assert frames_of(layout_of(tmp_path)) == (0, 5)


def test_an_offset_can_be_stated(tmp_path: Path) -> None:
    make_dataset(tmp_path, frames=["0", "1"])
    (tmp_path / "annotations_positions" / "0.json").unlink()
    assert list(layout_of(tmp_path, annotation_offset=1).annotations) == [0]


def test_annotations_that_begin_at_one_are_not_shifted_without_being_told(tmp_path: Path) -> None:
    make_dataset(tmp_path, frames=["0", "1"])
    (tmp_path / "annotations_positions" / "0.json").unlink()
    assert list(layout_of(tmp_path).annotations) == [1]


# What is wrong with a dataset


def test_a_folder_without_anything_is_refused(tmp_path: Path) -> None:
    assert "no such folder of images" in problems_of(tmp_path)[0]


def test_a_missing_root_is_refused(tmp_path: Path) -> None:
    assert "no such folder of images" in problems_of(tmp_path / "nowhere")[0]


def test_missing_calibrations_are_told(tmp_path: Path) -> None:
    touch(tmp_path / "images" / "A" / "1.png")
    assert any("no folder calibrations" in problem for problem in problems_of(tmp_path))


def test_a_camera_without_calibration_is_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    (tmp_path / "calibrations/extrinsic/extr_C2.xml").unlink()
    problems = problems_of(tmp_path)
    assert "calibrations/extrinsic: no file for camera C2" in problems
    assert "calibrations/intrinsic_zero/intr_C2.xml: belongs to no camera that has a pose" in problems


def test_calibration_of_a_camera_without_images_is_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    touch(tmp_path / "calibrations/extrinsic/extr_C4.xml")
    assert "calibrations/extrinsic/extr_C4.xml: belongs to no camera that has images" in problems_of(tmp_path)


def test_a_missing_intrinsic_file_is_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    (tmp_path / "calibrations/intrinsic_zero/intr_C2.xml").unlink()
    assert problems_of(tmp_path) == ["calibrations/intrinsic_zero: no file for camera C2 (C2)"]


def test_no_intrinsic_files_at_all_are_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    (tmp_path / "calibrations/intrinsic_zero").rename(tmp_path / "calibrations/elsewhere")
    assert any("no intrinsic files" in problem for problem in problems_of(tmp_path))


def test_frames_a_camera_lacks_are_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    (tmp_path / "Image_subsets/C2/00000005.png").unlink()
    assert any(
        "camera C2: no image of 1 frames other cameras have: 5" in each for each in problems_of(tmp_path)
    )


def test_two_files_of_one_frame_are_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    touch(tmp_path / "Image_subsets/C1/0005.jpg")
    assert any("has the same frame number as" in problem for problem in problems_of(tmp_path))


@pytest.mark.parametrize("name", ["cover.png", "12_left.png", "1234567890.png", "٣.png"])
def test_an_image_without_a_frame_number_is_told(tmp_path: Path, name: str) -> None:
    make_dataset(tmp_path)
    touch(tmp_path / "Image_subsets/C1" / name)
    assert any("does not end with a frame number" in problem for problem in problems_of(tmp_path))


def test_an_empty_camera_folder_is_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    (tmp_path / "Image_subsets/C4").mkdir()
    assert "Image_subsets/C4: no images in this folder" in problems_of(tmp_path)


def test_an_annotation_without_images_is_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    touch(tmp_path / "annotations_positions/00000007.json")
    assert problems_of(tmp_path) == ["annotations_positions/00000007.json: no images of frame 7"]


def test_everything_wrong_is_told_at_once(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    touch(tmp_path / "Image_subsets/C1/cover.png")
    touch(tmp_path / "annotations_positions/00000007.json")
    (tmp_path / "calibrations/extrinsic/extr_C3.xml").unlink()
    assert len(problems_of(tmp_path)) == 4


# Links


def test_an_image_that_links_out_of_the_dataset_is_refused(tmp_path: Path) -> None:
    make_dataset(tmp_path / "set")
    (tmp_path / "set/Image_subsets/C1/00000010.png").symlink_to(touch(tmp_path / "secret.png"))
    assert any("leads out of the dataset folder" in problem for problem in problems_of(tmp_path / "set"))


@pytest.mark.parametrize(
    "part", ["Image_subsets/C1", "Image_subsets", "calibrations", "annotations_positions"]
)
def test_a_folder_that_links_out_of_the_dataset_is_refused(tmp_path: Path, part: str) -> None:
    make_dataset(tmp_path / "set")
    (tmp_path / "set" / part).rename(tmp_path / "elsewhere")
    (tmp_path / "set" / part).symlink_to(tmp_path / "elsewhere")
    assert any("leads out of the dataset folder" in problem for problem in problems_of(tmp_path / "set"))


def test_a_neighbour_whose_name_begins_alike_is_outside(tmp_path: Path) -> None:
    make_dataset(tmp_path / "set")
    (tmp_path / "set/Image_subsets/C1/00000010.png").symlink_to(touch(tmp_path / "set-private/1.png"))
    assert any("leads out of the dataset folder" in problem for problem in problems_of(tmp_path / "set"))


def test_links_that_stay_inside_are_followed(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    (tmp_path / "Image_subsets").rename(tmp_path / "kept")
    (tmp_path / "Image_subsets").symlink_to("kept")
    assert frames_of(layout_of(tmp_path)) == (0, 5)


def test_a_dataset_may_itself_be_reached_through_a_link(tmp_path: Path) -> None:
    make_dataset(tmp_path / "set")
    (tmp_path / "link").symlink_to(tmp_path / "set")
    assert frames_of(layout_of(tmp_path / "link")) == (0, 5)


@pytest.mark.parametrize("target", ["00000010.png", "nothing.png"])
def test_links_that_lead_nowhere_are_told(tmp_path: Path, target: str) -> None:
    make_dataset(tmp_path)
    (tmp_path / "Image_subsets/C1/00000010.png").symlink_to(target)
    assert any("leads nowhere" in problem for problem in problems_of(tmp_path))


def test_a_name_that_is_not_text_can_be_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    os.close(os.open(os.fsencode(tmp_path) + b"/Image_subsets/C1/\xff.png", os.O_CREAT | os.O_WRONLY))
    "\n".join(problems_of(tmp_path)).encode()


def test_calibrations_and_annotations_may_be_chosen_anywhere(tmp_path: Path) -> None:
    make_dataset(tmp_path / "set")
    for name in ("calibrations", "annotations_positions"):
        (tmp_path / "set" / name).rename(tmp_path / f"my-{name}")
    layout = layout_of(
        tmp_path / "set",
        calibrations=tmp_path / "my-calibrations",
        annotations=tmp_path / "my-annotations_positions",
    )
    assert layout.calibrations.extrinsic["C1"].parent.parent.name == "my-calibrations"
    assert list(layout.annotations) == [0, 5]


def test_a_chosen_folder_of_annotations_that_is_not_there_is_told(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    assert problems_of(tmp_path, annotations=Path("other")) == ["other: no such folder of annotations"]


def test_a_caller_may_collect_the_problems_and_take_what_was_found(tmp_path: Path) -> None:
    make_dataset(tmp_path)
    (tmp_path / "Image_subsets" / "C2" / "00000005.png").unlink()
    problems = ProblemList(tmp_path)
    layout = find_layout(tmp_path, problems)
    assert [str(problem.reason) for problem in problems.found] == [
        "no image of 1 frames other cameras have: 5"
    ]
    assert layout.cameras == ("C1", "C2", "C3")


# Matching


def test_names_sort_by_the_numbers_in_them() -> None:
    assert sorted(["C10", "C2", "C1", "B"], key=natural_key) == ["B", "C1", "C2", "C10"]


@pytest.mark.parametrize(
    ("cameras", "names", "expected"),
    [
        (["c1", "c2"], ["C1", "C2"], {"c1": "C1", "c2": "C2"}),
        (["C1", "C3"], ["Camera1", "Camera2", "Camera3"], {"C1": "Camera1", "C3": "Camera3"}),
        (["C1", "C2", "C4"], ["Camera1", "Camera2", "Camera3"], {"C1": "Camera1", "C2": "Camera2"}),
        (["C0", "C1"], ["Camera1", "Camera2"], {"C0": "Camera1", "C1": "Camera2"}),
        (
            ["C1", "C2", "C3"],
            ["CVLab1", "IDIAP1", "IDIAP2"],
            {"C1": "CVLab1", "C2": "IDIAP1", "C3": "IDIAP2"},
        ),
        (["C1", "C2", "C3"], ["CVLab1", "IDIAP1"], {}),
    ],
)
def test_cameras_are_matched_by_name_then_number_then_order(
    cameras: list[str], names: list[str], expected: dict[str, str]
) -> None:
    assert match_names(cameras, names) == expected
