"""`calibrate check` and `calibrate export`, on the published cameras."""

from __future__ import annotations

import json
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.calibration.adjustment.problem import file_of
from gtm_hit.formats.calibration.ba_problem import read_ba_problem, write_ba_problem
from gtm_hit.formats.calibration.cameras_json import load_cameras, load_taken, save_cameras
from gtm_hit.formats.calibration.published_folder import read_folder
from gtm_hit.formats.calibration.wildtrack_xml import read_extrinsic
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import Camera, project
from tests.calibration.adjustment.scene import scene
from tests.geometry.scenes import FIXTURES, wildtrack_cameras

PUBLISHED = FIXTURES / "wildtrack_cameras.json"
CAMERAS = wildtrack_cameras(original=True)
POINT = (3.0, 9.0, 1.5)


def told(*words: object) -> dict[str, Any]:
    out = StringIO()
    call_command("calibrate", *map(str, words), "--json", stdout=out, stderr=StringIO())
    return json.loads(out.getvalue())


def clicks_file(folder: Path, *lines: str) -> Path:
    path = folder / "clicks.csv"
    path.write_text("\n".join(("thing,camera,x,y", *lines)))
    return path


def seen_in(*numbers: int) -> list[str]:
    pixels = [project(CAMERAS[number], [POINT])[0] for number in numbers]
    return [
        f"lamp,C{number + 1},{u!r},{v!r}"
        for number, (u, v) in zip(numbers, np.array(pixels).tolist(), strict=True)
    ]


def same(one: list[Camera], other: list[Camera], tolerance: float) -> None:
    assert [camera.name for camera in one] == [camera.name for camera in other]
    for here, there in zip(one, other, strict=True):
        for name in ("matrix", "distortion", "rvec", "tvec"):
            np.testing.assert_allclose(getattr(here, name), getattr(there, name), rtol=0, atol=tolerance)


def test_a_thing_is_where_it_is_with_the_other_views_pixels(tmp_path: Path) -> None:
    (thing,) = told("check", PUBLISHED, clicks_file(tmp_path, *seen_in(0, 5)))["things"]
    np.testing.assert_allclose(thing["point"], POINT, atol=1e-6)
    assert thing["height"] == pytest.approx(1.5, abs=1e-6)
    assert 0.1 < thing["ground_sigma_cm"] < 10
    assert [view["doubtful"] for view in thing["clicks"]] == [False, False]
    assert "C3" in thing["shown"]
    np.testing.assert_allclose(thing["shown"]["C3"], project(CAMERAS[2], [POINT])[0], atol=1e-3)


def test_json_clicks_and_a_spoiled_one_are_told(tmp_path: Path) -> None:
    entries = [line.split(",") for line in seen_in(0, 2, 5)]
    path = tmp_path / "clicks.json"
    path.write_text(
        json.dumps(
            [
                {"thing": thing, "camera": camera, "x": float(x) + 80 * (camera == "C3"), "y": float(y)}
                for thing, camera, x, y in entries
            ]
        )
    )
    found = told("check", PUBLISHED, path)
    assert found["doubtful"] == 1
    assert [view["camera"] for view in found["things"][0]["clicks"] if view["doubtful"]] == ["C3"]


def test_a_thing_in_one_view_is_told_to_be_nowhere(tmp_path: Path) -> None:
    found = told("check", PUBLISHED, clicks_file(tmp_path, *seen_in(0)))
    assert found["things"][0]["point"] is None
    assert found["things"][0]["reason"] == "clicked in one view only"
    assert found["median_px"] is None


@pytest.mark.parametrize(
    ("lines", "reason"),
    [
        (["lamp,C9,1,2"], "lamp: no camera C9; there are C1, C2"),
        (["lamp,C1,1,nan"], "line 2: y is 'nan' instead of a finite number"),
        (["lamp,C1,1"], "line 2: is no line of the form thing,camera,x,y"),
        (["lamp,C1,1,2", "lamp,C1,3,4"], "line 3: 'lamp' was clicked in 'C1' in line 2 already"),
        ([], "holds no click"),
    ],
)
def test_clicks_that_are_none_are_told(tmp_path: Path, lines: list[str], reason: str) -> None:
    with pytest.raises(CommandError, match=reason):
        told("check", PUBLISHED, clicks_file(tmp_path, *lines))


def test_json_clicks_that_are_none_are_told(tmp_path: Path) -> None:
    path = tmp_path / "clicks.json"
    path.write_text('[{"thing": "lamp", "camera": "C1", "x": "1", "y": 2}, 3]')
    with pytest.raises(CommandError, match=r"entry 0: is no object with thing(.|\n)*entry 1: is no object"):
        told("check", PUBLISHED, path)


@pytest.mark.parametrize("unit", ["cm", "m"])
def test_wildtracks_layout_is_read_back_and_says_its_unit(tmp_path: Path, unit: str) -> None:
    told("export", PUBLISHED, tmp_path / "out", "--format", "wildtrack", "--unit", unit)
    same(read_folder(tmp_path / "out", (1920, 1080)), CAMERAS, 1e-6)
    pose = tmp_path / "out" / "extrinsic" / "extr_C1.xml"
    assert f"<!-- tvec in {unit} -->" in pose.read_text()
    assert read_extrinsic(pose).tvec[2] == pytest.approx(CAMERAS[0].tvec[2] * (100 if unit == "cm" else 1))
    with pytest.raises(FormatError, match=f"says that tvec is in {unit}, not in mm"):
        read_folder(tmp_path / "out", (1920, 1080), "mm")


def test_the_published_folder_needs_its_unit_and_gives_the_published_cameras(
    shared_data: Path, tmp_path: Path
) -> None:
    folder = shared_data / "wildtrack" / "calibrations"
    with pytest.raises(CommandError, match="does not say in which unit tvec is"):
        told("export", folder, tmp_path / "cameras.json", "--format", "cameras-json")
    told("export", folder, tmp_path / "cameras.json", "--format", "cameras-json", "--from-unit", "cm")
    for here, there in zip(load_cameras(tmp_path / "cameras.json"), CAMERAS, strict=True):
        np.testing.assert_allclose(here.tvec, there.tvec, atol=1e-12)
        np.testing.assert_array_equal(here.distortion, there.distortion)


def test_json_is_read_back_to_the_last_bit_through_every_format(tmp_path: Path) -> None:
    told("export", PUBLISHED, tmp_path / "one.json", "--format", "cameras-json")
    same(load_taken(tmp_path / "one.json"), CAMERAS, 0)
    told("export", tmp_path / "one.json", tmp_path / "ba.txt", "--format", "ba-problem")
    told("export", tmp_path / "ba.txt", tmp_path / "two.json", "--format", "cameras-json")
    same(load_taken(tmp_path / "two.json"), CAMERAS, 1e-9)


def test_a_problem_keeps_its_points_and_clicks_in_another_unit(tmp_path: Path) -> None:
    problem, _ = scene()
    write_ba_problem(tmp_path / "cm.txt", file_of(problem, problem.views, problem.points))
    told("export", tmp_path / "cm.txt", tmp_path / "m.txt", "--format", "ba-problem", "--unit", "m")
    here, there = read_ba_problem(tmp_path / "cm.txt"), read_ba_problem(tmp_path / "m.txt", "m")
    np.testing.assert_allclose(there.points, here.points, rtol=1e-14)
    np.testing.assert_array_equal(there.seen.pixels, here.seen.pixels)


def test_a_lens_that_a_format_has_no_room_for_is_refused_and_nothing_written(tmp_path: Path) -> None:
    rational = [
        Camera(0, "C1", 1920, 1080, camera.matrix, camera.rvec, camera.tvec, np.full(8, 0.01))
        for camera in CAMERAS[:1]
    ]
    save_cameras(tmp_path / "cameras.json", rational)
    with pytest.raises(CommandError, match=r"C1: ba_problem\.txt has room for the lens k1 k2 p1 p2 k3 only"):
        told("export", tmp_path / "cameras.json", tmp_path / "ba.txt", "--format", "ba-problem")
    assert not (tmp_path / "ba.txt").exists()
