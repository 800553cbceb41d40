"""Clicks out of files: `.pos` by camera and frame, and a `ba_problem.txt` there and back."""

from __future__ import annotations

import io
import zipfile

import numpy as np
import pytest

from gtm_hit.formats.calibration.ba_problem import parse_ba_problem
from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Click, ClickFile, Desk, KeptPoint
from gtm_hit.ops.desk import (
    adjust_decisions,
    adjust_files,
    adjust_inputs,
    adjust_results,
    adjust_solving,
    desks,
    edits,
    poses,
)
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.errors import DeskError
from tests.adjust_scene import misplaced, noisy_desk, spot
from tests.check_scene import truth

pytestmark = pytest.mark.django_db

CAMERAS = ("C1", "C3", "C4", "C5")


@pytest.fixture
def desk() -> Desk:
    return noisy_desk(points=0)


def people() -> dict[tuple[str, str], bytes]:
    """Six people in each of two frames, feet and head, as `.pos` files of all cameras."""
    random = np.random.default_rng(3)
    files = {(camera, frame): "" for camera in CAMERAS for frame in ("0", "5")}
    for frame in ("0", "5"):
        for number in range(6):
            x, y = random.uniform(0, 7), random.uniform(0, 18)
            for camera in CAMERAS:
                parts = [spot(truth()[camera], (x, y, z)) for z in (0.0, 1.75)]
                lines = [f"{part} {at[0]:.1f} {at[1]:.1f}" for part, at in enumerate(parts) if at]
                if lines:
                    files[camera, frame] += "\n".join([f"p{number}", *lines]) + "\n\n"
    return {key: text.encode() for key, text in files.items()}


def zipped(files: dict[tuple[str, str], bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for (camera, frame), data in files.items():
            archive.writestr(f"clicks/{camera}/{frame}.pos", data)
    return stream.getvalue()


def test_feet_and_heads_of_pos_files_are_adjusted_with_and_their_height_is_told(desk: Desk) -> None:
    before = misplaced(desk)
    count = adjust_files.put_any(desk, zipped(people()), "clicks.zip")
    assert count == adjust_inputs.shared(desk).free > 12
    found = adjust_solving.solve(desk, Choices())
    adjust_results.use(desk)
    assert misplaced(desk) < before
    assert found.report is not None
    feet = found.report["feet"]
    assert not feet["guessed"] and feet["median"] < 0.05


def test_pos_files_come_out_as_they_went_in(desk: Desk) -> None:
    adjust_files.put_pos(desk, people(), "clicks")
    back = adjust_files.files_of_zip(adjust_files.pos_zip(desk))
    other = noisy_desk("other", points=0)
    adjust_files.put_pos(other, back, "back")
    one, two = ClickFile.objects.order_by("pk")
    assert one.points == two.points


def test_taking_clicks_is_one_step_and_leaving_them_out_another(desk: Desk) -> None:
    adjust_files.put_pos(desk, people(), "clicks")
    digest = desk.click_files.get().digest
    edits.undo(desk, adjust_results.PAGE)
    assert adjust_inputs.shared(desk).free == 0
    edits.redo(desk, adjust_results.PAGE)
    assert adjust_inputs.shared(desk).free > 12
    adjust_files.stop_using(desk, digest)
    assert adjust_inputs.shared(desk).free == 0
    with pytest.raises(DeskError, match="not adjust with such a file"):
        adjust_files.stop_using(desk, digest)


def test_a_click_of_a_file_can_be_dropped(desk: Desk) -> None:
    adjust_files.put_pos(desk, people(), "clicks")
    file = desk.click_files.get()
    point = next(each for each in file.points if len(each["clicks"]) > 2)
    camera = next(iter(point["clicks"]))
    before = len(adjust_inputs.gather(desk, Choices()).problem.seen.pixels)
    adjust_decisions.decide(desk, file.digest, point["name"], camera, "drop")
    assert len(adjust_inputs.gather(desk, Choices()).problem.seen.pixels) == before - 1


def test_a_problem_that_was_written_is_read_with_the_same_clicks_and_measured_points() -> None:
    desk = noisy_desk(points=12)
    text = adjust_files.problem_text(desk, Choices())
    file = parse_ba_problem(text.encode(), "ba_problem.txt")
    other = noisy_desk("other", points=0)
    Click.objects.filter(camera__desk=other).delete()
    assert adjust_files.put_any(other, text.encode(), "ba_problem.txt") == 12
    one, two = (adjust_inputs.gather(each, Choices()).problem for each in (desk, other))
    assert two.seen.pixels.tolist() == one.seen.pixels.tolist()
    assert two.measured_seen.pixels.tolist() == one.measured_seen.pixels.tolist()
    assert two.measured.tolist() == one.measured.tolist()
    camera = poses.calibrated(desk.cameras.get(name="C1"))
    assert camera is not None
    assert file.cameras[0, 3:6] == pytest.approx(camera.tvec, abs=1e-12)
    assert np.isfinite(file.points).all() and np.abs(file.points).max() < 60


def test_a_point_to_test_with_is_not_written() -> None:
    desk = noisy_desk(points=12)
    desk.kept_points.filter(name="P1").update(use=KeptPoint.Use.TEST)
    file = parse_ba_problem(adjust_files.problem_text(desk, Choices()).encode(), "ba_problem.txt")
    assert len(file.points) == 11


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "line 1"),
        (b"3 0 0 0 0\n" + b"1\n" * 45, "3 cameras, the desk 4"),
        (zipped({("C9", "0"): b"p\n0 1 1\n"}), "no camera C9"),
        (zipped({("C1", "0"): b"p\n0 1 1\n"}), "seen by two cameras"),
        (zipped({(each, "0"): b"p\n0 99999 1\n" for each in CAMERAS}), "far outside"),
        (zipped({(each, "0"): b"p\n0 one 1\n" for each in CAMERAS}), "line 2"),
        (b"PK broken", "no zip"),
    ],
)
def test_a_file_that_does_not_fit_is_refused_and_nothing_is_taken(desk: Desk, data: bytes, told: str) -> None:
    with pytest.raises((DeskError, FormatError), match=told):
        adjust_files.put_any(desk, data, "file")
    assert not desk.click_files.exists() and not desk.edits.filter(page="adjust").exists()


def test_a_problem_cannot_be_written_of_cameras_that_stand_nowhere() -> None:
    with pytest.raises(DeskError, match="No lens yet: C1"):
        adjust_files.problem_text(desks.make("bare", cameras=["C1"]), Choices())
