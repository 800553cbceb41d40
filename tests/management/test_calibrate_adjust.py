"""`calibrate adjust` on a small problem whose answer is known."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.calibration.adjustment.problem import file_of
from gtm_hit.formats.calibration.ba_problem import read_ba_problem, write_ba_problem
from gtm_hit.formats.calibration.cameras_json import load_cameras
from tests.calibration.adjustment.scene import scene, true_cameras
from tests.conftest import REPOSITORY


@pytest.fixture
def problem_file(tmp_path: Path) -> Path:
    problem, _ = scene(cameras=3, noise=0.3)
    path = tmp_path / "ba_problem.txt"
    write_ba_problem(path, file_of(problem, problem.views, problem.points))
    return path


def adjusted(path: Path, *words: str) -> dict[str, Any]:
    out = StringIO()
    call_command("calibrate", "adjust", str(path), *words, "--json", stdout=out, stderr=StringIO())
    return json.loads(out.getvalue())


@pytest.mark.parametrize("variant", ["fixed", "both", "two-pass", "soft"])
def test_every_variant_tells_cost_misses_centres_and_folding(problem_file: Path, variant: str) -> None:
    told = adjusted(problem_file, "--variant", variant)
    assert told["variant"] == variant
    assert told["cost"] > 0 and told["median_px"] < 1 and told["seconds"] >= 0
    assert told["monotone"] is False  # the published lens of C1 folds, and it is where this starts
    for camera in true_cameras(3):
        assert np.linalg.norm(camera.centre - told["centres"][camera.name]) < 0.1


def test_a_folder_holds_the_problem_the_cameras_and_the_report(problem_file: Path, tmp_path: Path) -> None:
    told = adjusted(problem_file, "--output", str(tmp_path / "out"), "--names", "north,south,west")
    cameras = load_cameras(tmp_path / "out" / "cameras.json")
    file = read_ba_problem(tmp_path / "out" / "ba_problem.txt")
    assert [camera.name for camera in cameras] == ["north", "south", "west"]
    assert json.loads((tmp_path / "out" / "report.json").read_text()) == told
    for row, camera in zip(file.cameras, cameras, strict=True):
        np.testing.assert_allclose(row[3:6], camera.tvec, rtol=1e-12)
        np.testing.assert_array_equal(row[10:], camera.distortion)


def test_what_is_held_stays(problem_file: Path, tmp_path: Path) -> None:
    hold = ("--hold", "C1:pose", "--hold", "C2:fx,fy")
    adjusted(problem_file, "--variant", "both", *hold, "--output", str(tmp_path / "again.txt"))
    before, after = read_ba_problem(problem_file).cameras, read_ba_problem(tmp_path / "again.txt").cameras
    np.testing.assert_allclose(after[0, :6], before[0, :6], rtol=1e-14)
    assert (after[1, 6:8] == before[1, 6:8]).all() and (after[0, 6:8] != before[0, 6:8]).all()


def test_the_same_file_gives_the_same_bytes(problem_file: Path, tmp_path: Path) -> None:
    for name in ("one.txt", "two.txt"):
        adjusted(problem_file, "--output", str(tmp_path / name))
    assert (tmp_path / "one.txt").read_bytes() == (tmp_path / "two.txt").read_bytes()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--names", "a,b"), "The file has 3 cameras; --names has 2"),
        (("--hold", "C9:pose"), "write CAMERA:WHAT with one of the cameras C1, C2, C3"),
        (("--hold", "C1:focal"), "there is no parameter focal"),
        (("--ground-sigma", "-1"), "must be 0 or more"),
        (("--image-size", "640x480"), "far outside its picture of 640×480"),
    ],
)
def test_what_makes_no_sense_is_refused_in_a_sentence(
    problem_file: Path, words: tuple[str, ...], told: str
) -> None:
    with pytest.raises(CommandError, match=told):
        adjusted(problem_file, *words)


def test_a_file_that_is_none_is_told_line_by_line(tmp_path: Path) -> None:
    path = tmp_path / "ba_problem.txt"
    path.write_text("1 0 0 0 0\n1 2 3 4 5 6 x 8 9 10 11 12 13 14 15\n")
    with pytest.raises(CommandError, match="line 2: a camera's number is 'x'"):
        adjusted(path)


def test_interrupted_it_keeps_its_state_and_ends_with_the_same_cameras(
    problem_file: Path, tmp_path: Path
) -> None:
    state, stopped, whole = tmp_path / "state.json", tmp_path / "stopped.txt", tmp_path / "whole.txt"
    command = [sys.executable, "-c", INTERRUPTED, str(problem_file), str(state), str(stopped)]
    process = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True)
    assert "the same command goes on from" in process.stderr, process.stderr
    assert state.exists() and not stopped.exists()
    adjusted(problem_file, "--state", str(state), "--output", str(stopped))
    adjusted(problem_file, "--output", str(whole))
    assert stopped.read_bytes() == whole.read_bytes()
    assert not state.exists()


INTERRUPTED = f"""
import os, signal, sys
os.environ["DJANGO_SETTINGS_MODULE"] = "tests.settings"
import django
django.setup()
from django.core.management import CommandError, call_command
from gtm_hit.calibration.adjustment import adjusting
step_down, steps = adjusting.step_down, []
def interrupted(*given):
    steps.append(1)
    if len(steps) == 3:
        os.kill(os.getpid(), {signal.SIGINT.value})
    return step_down(*given)
adjusting.step_down = interrupted
try:
    call_command("calibrate", "adjust", sys.argv[1], "--state", sys.argv[2], "--output", sys.argv[3])
except CommandError as error:
    sys.exit(str(error))
"""
