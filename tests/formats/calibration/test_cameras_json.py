from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.formats.calibration.cameras_json import load_cameras, save_cameras
from gtm_hit.formats.problems import FormatError
from tests.conftest import REPOSITORY

PUBLISHED = REPOSITORY / "fixtures" / "wildtrack_cameras.json"


def published() -> dict[str, Any]:
    return json.loads(PUBLISHED.read_text())


def written(folder: Path, content: Any) -> Path:
    path = folder / "cameras.json"
    path.write_text(json.dumps(content))
    return path


def problems_of(path: Path, **options: bool) -> list[tuple[str, str]]:
    with pytest.raises(FormatError) as caught:
        load_cameras(path, **options)
    assert all(problem.path == str(path) for problem in caught.value.problems)
    return [(problem.place, problem.reason) for problem in caught.value.problems]


def test_the_seven_published_cameras_are_read_in_order() -> None:
    cameras = load_cameras(PUBLISHED)
    assert [(camera.index, camera.name) for camera in cameras] == [(i, f"C{i + 1}") for i in range(7)]
    assert not any(camera.has_lens for camera in cameras)
    assert cameras[0].tvec.tolist() == [-5.258941650390625, 0.4540763473510742, 9.867235107421875]


def test_the_original_numbers_keep_the_pose_and_have_a_lens() -> None:
    for zero, original in zip(load_cameras(PUBLISHED), load_cameras(PUBLISHED, original=True), strict=True):
        assert original.has_lens
        np.testing.assert_array_equal(original.rvec, zero.rvec)
        np.testing.assert_array_equal(original.tvec, zero.tvec)


def test_cameras_written_are_read_back_to_the_last_bit(tmp_path: Path) -> None:
    cameras = load_cameras(PUBLISHED, original=True)
    save_cameras(tmp_path / "cameras.json", cameras)
    again = load_cameras(tmp_path / "cameras.json")
    assert [camera.as_json() for camera in again] == [camera.as_json() for camera in cameras]


def test_writing_twice_gives_the_same_bytes_and_leaves_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "cameras.json"
    save_cameras(path, load_cameras(PUBLISHED))
    first = path.read_bytes()
    save_cameras(path, load_cameras(path))
    assert path.read_bytes() == first
    assert list(tmp_path.iterdir()) == [path]


def test_distortion_may_be_left_out(tmp_path: Path) -> None:
    content = published()
    del content["cameras"][0]["distortion"]
    assert not load_cameras(written(tmp_path, content))[0].has_lens


def test_everything_wrong_is_reported_at_once(tmp_path: Path) -> None:
    content = published()
    cameras = content["cameras"]
    del cameras[0]["rvec"]
    cameras[1]["width"] = "1920"
    cameras[2]["matrix"][0][0] = -1
    cameras[3] = 7
    cameras[4]["distortion"] = [0.1]
    cameras[6]["name"] = "C6"
    found = problems_of(written(tmp_path, content))
    assert [place for place, _ in found] == [*(f"cameras[{index}]" for index in range(5)), "cameras"]
    expected = [
        "rvec is missing",
        "width is",
        "focal",
        "not an object",
        "1 numbers",
        "more than one is named",
    ]
    for (_, reason), words in zip(found, expected, strict=True):
        assert words in reason


def test_original_numbers_that_are_missing_are_a_problem_only_when_asked_for(tmp_path: Path) -> None:
    content = published()
    del content["cameras"][2]["original"]
    path = written(tmp_path, content)
    assert len(load_cameras(path)) == 7
    assert problems_of(path, original=True) == [("cameras[2]", "original is missing")]


@pytest.mark.parametrize(
    "content",
    [[], {}, {"format": "gtm-cameras", "version": 2, "cameras": []}, {"format": "other", "version": 1}],
)
def test_another_kind_of_file_is_refused(tmp_path: Path, content: Any) -> None:
    ((_, reason),) = problems_of(written(tmp_path, content))
    assert "gtm-cameras" in reason


def test_a_file_without_cameras_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, {"format": "gtm-cameras", "version": 1, "cameras": []})
    assert problems_of(path) == [("cameras", "not a list of at least one camera")]


def test_a_file_that_is_not_there_is_a_problem(tmp_path: Path) -> None:
    assert problems_of(tmp_path / "none.json") == [("", "no such file")]


@given(st.binary(max_size=200))
def test_arbitrary_bytes_are_refused_and_nothing_worse(
    tmp_path_factory: pytest.TempPathFactory, data: bytes
) -> None:
    path = tmp_path_factory.mktemp("fuzz") / "cameras.json"
    path.write_bytes(data)
    problems_of(path)


json_values = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)


@given(
    key=st.sampled_from(["name", "width", "height", "matrix", "rvec", "tvec", "distortion", "original"]),
    value=json_values,
    original=st.booleans(),
)
def test_any_value_in_any_place_gives_cameras_or_problems(
    tmp_path_factory: pytest.TempPathFactory, key: str, value: Any, original: bool
) -> None:
    content = published()
    content["cameras"][3][key] = value
    path = written(tmp_path_factory.mktemp("fuzz"), content)
    try:
        assert len(load_cameras(path, original)) == 7
    except FormatError as error:
        assert {problem.place for problem in error.problems} <= {"cameras[3]", "cameras"}
