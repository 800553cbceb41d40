"""Marks found again: what has moved is told, and what has not is left in peace."""

from __future__ import annotations

import json
from io import StringIO
from pathlib import Path

import cv2
import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.calibration.drift.checking import A_LITTLE, MOVED, STILL, UNKNOWN, check
from gtm_hit.calibration.drift.marks import DriftError, Marks, choose, marks_of
from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.geometry.camera import Camera, back_project
from tests.calibration.drift.street import HEIGHT, WIDTH, street
from tests.dataset_folder import cameras


@pytest.fixture(scope="module")
def marks() -> Marks:
    return choose([street(people=6, seed=seed) for seed in range(1, 8)])


def camera() -> Camera:
    first = cameras()[0]
    matrix = np.array([[600.0, 0, WIDTH / 2], [0, 600.0, HEIGHT / 2], [0, 0, 1]])
    return Camera(0, "C1", WIDTH, HEIGHT, matrix, first.rvec, first.tvec, np.zeros(5))


@pytest.mark.parametrize(("dx", "dy"), [(3.0, 0.0), (0.0, -3.0), (2.1, 2.14), (25.3, -18.6)])
def test_a_shift_is_found_within_a_third_of_a_pixel(marks: Marks, dx: float, dy: float) -> None:
    found = check("C3", marks, street(dx, dy, people=8, seed=50), camera())
    assert found.state == MOVED and found.px == pytest.approx(np.hypot(dx, dy), abs=0.3)
    assert found.sigma_px is not None and found.sigma_px < 0.1
    assert found.verdict.startswith(f"C3 has moved by {found.px:.1f} px (")


@pytest.mark.parametrize("seed", range(20, 26))
def test_noise_other_light_and_people_pass_as_steady(marks: Marks, seed: int) -> None:
    dimmed = cv2.convertScaleAbs(street(0.3, -0.2, people=12, seed=seed, noise=6), alpha=0.6, beta=35)
    found = check("C3", marks, dimmed)
    assert found.state == STILL and found.verdict == f"C3 is steady: {found.px:.1f} px."


def test_between_half_a_pixel_and_two_nothing_is_warned_of(marks: Marks) -> None:
    assert check("C3", marks, street(1.2)).state == A_LITTLE


def test_a_turn_about_the_middle_moves_the_rim_most_and_is_told_in_degrees(marks: Marks) -> None:
    found = check("C3", marks, street(degrees=0.6, people=5, seed=3))
    assert found.state == MOVED and found.degrees == pytest.approx(0.6, abs=0.02)
    assert found.most_px is not None and found.px is not None and found.most_px > 1.3 * found.px
    assert f"up to {found.most_px:.1f} px" in found.verdict


def test_nothing_is_told_of_another_place_or_a_covered_lens(marks: Marks) -> None:
    covered = np.full((HEIGHT, WIDTH), 90, np.uint8)
    for picture in (covered, street(size=(WIDTH, HEIGHT))[::-1].copy()):
        found = check("C3", marks, picture)
        assert (found.state, found.px) == (UNKNOWN, None)
        assert "cannot tell" in found.verdict and "too few marks" in found.verdict


def test_centimetres_are_what_the_calibration_misplaces_on_the_ground(marks: Marks) -> None:
    found = check("C1", marks, street(3.0), camera())
    pixels = np.stack(np.meshgrid(np.linspace(0, WIDTH - 1, 40), np.linspace(0, HEIGHT - 1, 40)), -1).reshape(
        -1, 2
    )
    apart = np.hypot(
        *(back_project(camera(), pixels + np.array([3.0, 0.0])) - back_project(camera(), pixels)).T
    )
    near = np.hypot(*(back_project(camera(), pixels) - camera().centre[:2]).T) < 60
    assert found.cm == pytest.approx(100 * np.median(apart[near]), rel=0.1)


def test_no_mark_lies_where_somebody_passed(marks: Marks) -> None:
    stones = street()
    for mark in marks.marks:
        x, y = mark.x - 16, mark.y - 16
        still = stones[y : y + 33, x : x + 33].astype(float)
        assert np.abs(still - mark.piece).mean() < 4
    assert len(marks.marks) > 20


def test_marks_are_the_same_after_being_kept_as_json(marks: Marks) -> None:
    kept = marks_of(json.loads(json.dumps(marks.as_json())))
    later = street(1.0, people=3, seed=8)
    assert check("C3", kept, later) == check("C3", marks, later)


def test_a_picture_of_another_size_is_refused_by_name(marks: Marks) -> None:
    with pytest.raises(
        DriftError, match="C3: the picture has 320×240 pixels, its marks are of one with 640×480"
    ):
        check("C3", marks, street(size=(320, 240)))
    with pytest.raises(DriftError, match="320×240"):
        choose([street(), street(size=(320, 240))])


# By command


def pictures(folder: Path, dx: float) -> Path:
    folder.mkdir()
    for seed in range(3):
        cv2.imwrite(str(folder / f"{seed}.png"), street(dx, people=4, seed=seed))
    return folder


def test_the_command_compares_folders_of_pictures(tmp_path: Path) -> None:
    save_cameras(tmp_path / "cameras.json", [camera()])
    before, later = pictures(tmp_path / "C1", 0.0), pictures(tmp_path / "later", 3.0)
    out = StringIO()
    call_command(
        "calibrate",
        "drift",
        str(before),
        str(later),
        "--cameras",
        str(tmp_path / "cameras.json"),
        "--json",
        stdout=out,
    )
    found = json.loads(out.getvalue())
    assert found["warns"] and [each["picture"] for each in found["pictures"]] == ["0.png", "1.png", "2.png"]
    assert all(each["px"] == pytest.approx(3, abs=0.3) and each["cm"] > 0 for each in found["pictures"])


def test_a_camera_the_file_does_not_have_is_named_with_those_there_are(tmp_path: Path) -> None:
    save_cameras(tmp_path / "cameras.json", [camera()])
    before = pictures(tmp_path / "north", 0.0)
    with pytest.raises(CommandError, match=r"no camera north; there are C1.*--camera"):
        call_command(
            "calibrate", "drift", str(before), str(before), "--cameras", str(tmp_path / "cameras.json")
        )
