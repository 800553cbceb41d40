"""Detectors in Python, as CVAT's auto-annotation functions are written, and how broken ones fail."""

from __future__ import annotations

from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gtm_hit.vision.boxes import Box
from gtm_hit.vision.detectors import DetectorError, from_entry_point, from_file, from_module, python_plug
from gtm_hit.vision.detectors.python_plug import PythonDetector, PythonLocator
from gtm_hit.vision.proposing import Method, Proposer, Scene, Settings
from tests.vision.plaza import CAMERAS, GRID, pictures

CVAT_STYLE = Path(__file__).with_name("cvat_style.py")
PICTURE = np.full((54, 96, 3), 140, np.uint8)
PICTURE[10:40, 20:30] = 30


def written(folder: Path, code: str) -> Path:
    file = folder / "theirs.py"
    file.write_text(code)
    return file


def detect(file: Path, **params: Any) -> list[Box]:
    detector = from_file(file, params)
    assert isinstance(detector, PythonDetector)
    return detector.detect(PICTURE)


def test_a_function_of_cvats_is_taken_unchanged_and_only_its_people() -> None:
    assert detect(CVAT_STYLE) == [Box(20, 10, 30, 40, 1.0)]


def test_parameters_reach_create_and_are_part_of_the_version() -> None:
    assert detect(CVAT_STYLE, below=10) == []
    usual, other = from_file(CVAT_STYLE, {}), from_file(CVAT_STYLE, {"below": 10})
    assert usual.version.startswith("cvat_style-") and usual.version != other.version


def test_a_module_and_an_entry_point_give_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    point = EntryPoint("dark", "tests.vision.cvat_style:create", python_plug.GROUP)
    monkeypatch.setattr(python_plug, "entry_points", lambda **_asked: [point])
    for detector in (from_module("tests.vision.cvat_style", {}), from_entry_point("dark", {})):
        assert isinstance(detector, PythonDetector)
        assert detector.detect(PICTURE) == [Box(20, 10, 30, 40, 1.0)]


def test_a_module_that_is_a_function_itself_may_answer_plain_boxes(tmp_path: Path) -> None:
    code = "def detect(context, image):\n    yield (1, 2, image.width - 6, 4, 0.5)\n"
    assert detect(written(tmp_path, code)) == [Box(1, 2, 90, 4, 0.5)]


def test_a_model_of_all_views_proposes_its_own_places(tmp_path: Path) -> None:
    code = (
        "def locate(context, images, cameras, grid):\n"
        "    assert context.frame_name == '35' and set(images) == set(cameras)\n"
        "    return [(grid.origin_x + 1, 0.5, 0.8, None), (500.0, 0, 0.9), (1, 1, 0.1, 7)]\n"
    )
    locator = from_file(written(tmp_path, code), {})
    assert isinstance(locator, PythonLocator)
    proposer = Proposer(Scene(CAMERAS, GRID), Method.COVER, locator, Settings())
    assert proposer.method is Method.LOCATED
    (person,) = proposer.frame(pictures([]), number=35).people  # not who is outside, nor who is doubtful
    assert (person.x, person.y, person.score, person.method) == (-2.0, 0.5, 0.8, "located")


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("def detect(context, image):\n    raise MemoryError('too large')\n", "MemoryError: too large"),
        ("def detect(context, image):\n    return None\n", "list of boxes"),
        ("def detect(context, image):\n    return [(1, 2, 3)]\n", "x1, y1, x2, y2, score"),
        ("def detect(context, image):\n    return [(9, 2, 3, 4, 0.5)]\n", "ends before it begins"),
        ("def detect(context, image):\n    return ['person']\n", "str has no type"),
        ("def detect(context):\n    return []\n", "TypeError"),
        ("def create():\n    return 1 / 0\n", "ZeroDivisionError"),
        ("import no_such_package\n", "no_such_package"),
        ("x = 1\n", "neither detect"),
        ("def detect(:\n", "SyntaxError"),
    ],
)
def test_a_broken_one_fails_with_words(tmp_path: Path, code: str, words: str) -> None:
    with pytest.raises(DetectorError, match=words):
        detect(written(tmp_path, code))


def test_what_is_not_there_is_said(tmp_path: Path) -> None:
    for find in (
        lambda: from_file(tmp_path / "none.py", {}),
        lambda: from_module("tests.no_such_module", {}),
        lambda: from_entry_point("nobody", {}),
        lambda: from_file(CVAT_STYLE, {"unknown": 1}),
    ):
        with pytest.raises(DetectorError):
            find()
