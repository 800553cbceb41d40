"""`manage.py calibrate lens`, with files alone."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from io import StringIO
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from django.core.management import CommandError, call_command

from tests.calibration.board_scene import LENS, write_pictures

ROOT = Path(__file__).resolve().parent.parent.parent
BOARD = ("--board", "chessboard", "--size", "8x5", "--spacing", "0.03")


def process(*arguments: str) -> subprocess.CompletedProcess[str]:
    variables = {
        "PATH": os.environ["PATH"],
        "SECRET_KEY": "k" * 40,
        "DATABASE_URL": "sqlite:////nowhere/at/all",
    }
    command = [sys.executable, "manage.py", "calibrate", "lens", *arguments]
    return subprocess.run(command, cwd=ROOT, env=variables, capture_output=True, text=True, timeout=120)


def run(*arguments: str) -> tuple[dict[str, Any], str]:
    out, told = StringIO(), StringIO()
    call_command("calibrate", "lens", *arguments, "--json", stdout=out, stderr=told)
    return json.loads(out.getvalue()), told.getvalue()


def test_a_process_prints_one_json_object_and_needs_no_database(tmp_path: Path) -> None:
    write_pictures(tmp_path, 9)
    cv2.imwrite(str(tmp_path / "wall.png"), np.full((400, 640), 128, np.uint8))
    done = process(str(tmp_path), *BOARD, "--json")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert (told["found"], told["pictures"]) == (9, 10)
    assert told["rms"] < 0.06
    assert told["camera_matrix"][0][0] == pytest.approx(LENS.matrix[0, 0], rel=0.002)
    assert told["verdict"] in {"good", "usable"}
    assert told["missing"] == [{"name": "wall.png", "reason": told["missing"][0]["reason"]}]
    assert "contrast" in told["missing"][0]["reason"]
    assert "Found in 9 of 10" in done.stderr


def test_people_read_numbers_with_spread_bars_per_view_and_the_verdict(tmp_path: Path) -> None:
    out = StringIO()
    call_command("calibrate", "lens", str(write_pictures(tmp_path)), *BOARD, stdout=out)
    text = out.getvalue()
    assert "Chessboard, 8×5 inner corners, squares of 30 mm; 8 pictures of 640×400" in text
    assert "±" in text and "RMS" in text and "█" in text
    assert text.rstrip().splitlines()[-1].startswith("Next: ")


def test_a_view_can_be_left_out_and_a_model_chosen(tmp_path: Path) -> None:
    told, _ = run(str(write_pictures(tmp_path)), *BOARD, "--without", "03.png", "--model", "two")
    assert [view["name"] for view in told["views"]] == [f"{n:02d}.png" for n in (0, 1, 2, 4, 5, 6, 7)]
    assert told["distortion"][2:] == [0, 0, 0]
    assert told["model"]["coefficients"] == "two"


def test_of_many_views_the_most_useful_are_solved(tmp_path: Path) -> None:
    told, said = run(str(write_pictures(tmp_path)), *BOARD, "--views", "5")
    assert (told["found"], len(told["views"])) == (8, 5)
    assert "most useful" in said


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--size", "9x6", "--spacing", "0.03"), "--size 8x5 would fit"),
        (("--size", "8x5", "--spacing", "30"), "millimetres"),
        (("--size", "8x5", "--spacing", "0.03", "--without", "nobody.png"), "nobody.png"),
        (("--size", "eight", "--spacing", "0.03"), "9x6"),
        (("--board", "charuco", "--size", "8x5", "--spacing", "0.03", "--dictionary", "X"), "dictionary"),
    ],
)
def test_what_cannot_be_is_refused_with_a_sentence(
    tmp_path: Path, arguments: tuple[str, ...], said: str
) -> None:
    with pytest.raises(CommandError, match=said):
        run(str(write_pictures(tmp_path, 3)), *arguments)


def test_a_process_refuses_without_a_traceback(tmp_path: Path) -> None:
    done = process(str(tmp_path / "nowhere"), *BOARD)
    assert done.returncode == 1
    assert "is not there" in done.stderr and "Traceback" not in done.stderr
