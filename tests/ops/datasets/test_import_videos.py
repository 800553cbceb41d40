from __future__ import annotations

import io
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from threading import Lock

import cv2
import numpy as np
import pytest
from django.core.files.storage import default_storage
from django.core.management import call_command
from PIL import Image as Picture

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.models import Frame, Image
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.datasets.videos import importing
from gtm_hit.ops.datasets.videos.importing import import_videos
from gtm_hit.ops.datasets.videos.nearest import Taken
from gtm_hit.ops.files.images import storage_name
from tests.dataset_folder import NAMES, cameras
from tests.video_files import make_video, make_videos, number_in, video_options

pytestmark = pytest.mark.django_db

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(autouse=True)
def own_storage(settings: object, tmp_path: Path) -> None:
    settings.DATA_DIR = tmp_path / "data"  # type: ignore[attr-defined]
    settings.MEDIA_ROOT = tmp_path / "data" / "media"  # type: ignore[attr-defined]
    settings.TABLES_ROOT = tmp_path / "data" / "tables"  # type: ignore[attr-defined]


def stored(camera: str) -> dict[int, int]:
    """By frame number, which picture of the video it shows."""
    found = {}
    for image in Image.objects.filter(camera__name=camera).select_related("frame"):
        with default_storage.open(storage_name(image.full_digest)) as stream:
            found[image.frame.number] = number_in(np.asarray(Picture.open(stream)))
    return found


def failure(root: Path, *offsets: float, **changes: object) -> list[str]:
    with pytest.raises(ImportFailed) as caught:
        import_videos(video_options(root, *offsets, **changes))
    assert not Frame.objects.exists()
    return [str(problem) for problem in caught.value.problems]


# Which pictures


def test_frames_are_numbered_at_ten_a_second_and_every_fifth_is_taken(tmp_path: Path) -> None:
    make_videos(tmp_path, 90, 30.0)
    report = import_videos(video_options(tmp_path))
    assert (report.frames_added, report.images_added) == (6, 18)
    for name in NAMES:
        assert stored(name) == {number: 3 * number for number in range(0, 30, 5)}


def test_an_offset_is_the_second_in_the_video_where_shared_time_begins(tmp_path: Path) -> None:
    make_videos(tmp_path, 90, 30.0)
    import_videos(video_options(tmp_path, 0.0, 0.1, 1.0))
    assert stored("C1") == {0: 0, 5: 15, 10: 30, 15: 45}
    assert stored("C2") == {0: 3, 5: 18, 10: 33, 15: 48}
    assert stored("C3") == {0: 30, 5: 45, 10: 60, 15: 75}


def test_a_camera_that_was_switched_on_late_makes_frames_begin_later(tmp_path: Path) -> None:
    make_videos(tmp_path, 90, 30.0)
    import_videos(video_options(tmp_path, 0.0, -0.7, 0.0))
    assert stored("C1") == {10: 30, 15: 45, 20: 60, 25: 75}
    assert stored("C2") == {10: 9, 15: 24, 20: 39, 25: 54}


def test_cameras_may_differ_in_rate_and_container(tmp_path: Path) -> None:
    make_videos(tmp_path, 90, 30.0)
    make_video(tmp_path / "C2.mp4", 75, 25.0)
    report = import_videos(video_options(tmp_path))
    assert stored("C2") == {0: 0, 5: 12, 10: 25, 15: 37, 20: 50, 25: 62}
    assert report.deviations["C1"] < 0.001
    assert report.deviations["C2"] == pytest.approx(0.02, abs=0.001)
    assert "pictures are at most 20.0 ms from the time of their frame (C2)" in report.notes


@pytest.mark.parametrize(
    ("changes", "numbers"),
    [
        ({"start": 0.9, "until": 2.0}, [10, 15, 20]),
        ({"values": {"frame_rate": 10.0, "frame_step": 2}, "until": 1.0}, [0, 2, 4, 6, 8, 10]),
        ({"values": {"frame_rate": 2.0, "frame_step": 1}}, [0, 1, 2, 3, 4, 5]),
    ],
)
def test_rate_step_and_time_are_chosen(tmp_path: Path, changes: dict, numbers: list[int]) -> None:
    make_videos(tmp_path, 90, 30.0)
    import_videos(video_options(tmp_path, **changes))
    assert list(Frame.objects.values_list("number", flat=True)) == numbers


def test_a_video_shorter_than_its_header_says_ends_the_frames(tmp_path: Path) -> None:
    make_videos(tmp_path, 120, 30.0, ".mkv")
    path = tmp_path / "C2.mkv"
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    report = import_videos(video_options(tmp_path))
    assert 0 < report.frames_added < 8
    assert len(stored("C1")) == len(stored("C2")) == report.frames_added
    assert any("the video of C2 ends before" in note for note in report.notes)


def test_the_lens_is_taken_out_of_the_pictures(tmp_path: Path) -> None:
    make_videos(tmp_path, 30)
    bent = [
        {**entry, "distortion": [-0.3, 0.1, 0, 0, 0]}
        for entry in json.loads(cameras_json(tmp_path))["cameras"]
    ]
    calibration = tmp_path / "bent.json"
    calibration.write_text(json.dumps({"format": "gtm-cameras", "version": 1, "cameras": bent}))
    dataset = import_videos(video_options(tmp_path, calibrations=calibration)).dataset
    assert dataset is not None and dataset.undistorted
    assert all(not camera.distortion.any() for camera in dataset.calibrated_cameras())
    image = Image.objects.filter(frame__number=0).order_by("camera__index")[0]
    with default_storage.open(storage_name(image.full_digest)) as stream:
        found = np.asarray(Picture.open(stream).convert("L"))
    assert found[0, 0] < 40 and found[120, 5] < 40  # barrel distortion taken out leaves black corners


def cameras_json(folder: Path) -> str:
    path = folder / "made.json"
    save_cameras(path, cameras())
    return path.read_text()


# Again, and after a kill


def test_a_second_run_adds_nothing(tmp_path: Path) -> None:
    make_videos(tmp_path)
    import_videos(video_options(tmp_path))
    report = import_videos(video_options(tmp_path))
    assert (report.frames_added, report.frames_known) == (0, 6)
    assert Image.objects.count() == 18


def test_longer_videos_are_continued(tmp_path: Path) -> None:
    make_videos(tmp_path)
    import_videos(video_options(tmp_path, until=1.0))
    report = import_videos(video_options(tmp_path))
    assert (report.frames_added, report.frames_known) == (3, 3)
    assert stored("C3") == {number: 3 * number for number in range(0, 30, 5)}


def test_other_offsets_than_last_time_are_refused(tmp_path: Path) -> None:
    make_videos(tmp_path)
    import_videos(video_options(tmp_path, until=1.0))
    with pytest.raises(ImportFailed) as caught:
        import_videos(video_options(tmp_path, 0.0, 0.1, 0.0))
    assert {problem.path for problem in caught.value.problems} >= {"Image_subsets/C2/00000000.png"}
    assert Frame.objects.count() == 3


def test_a_second_import_at_the_same_time_is_refused(tmp_path: Path) -> None:
    make_videos(tmp_path)
    with importing._own_folder("square"):
        (problem,) = failure(tmp_path)
    assert "another import of videos" in problem


KILLED = """
import sys, django
django.setup()
from pathlib import Path
from gtm_hit.ops.datasets.videos import importing
from tests.video_files import video_options
importing.INSTANTS_TOGETHER = 2
importing.import_videos(video_options(Path(sys.argv[1])), lambda *told: print(*told, flush=True))
"""


@pytest.mark.django_db(databases=[])
def test_a_killed_run_is_continued_and_doubles_nothing(tmp_path: Path) -> None:
    make_videos(tmp_path, 600)
    environment = {
        **os.environ,
        "DJANGO_SETTINGS_MODULE": "annotator.settings",
        "SECRET_KEY": "k" * 50,
        "DATA_DIR": str(tmp_path / "killed"),
        "DATABASE_URL": f"sqlite:///{tmp_path / 'killed.sqlite3'}",
    }

    def start(*words: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, *words], cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True
        )

    def asked(code: str) -> str:
        process = start("-c", f"import django; django.setup(); from gtm_hit.models import *; print({code})")
        return process.communicate(timeout=60)[0].strip()

    assert start("manage.py", "migrate", "-v0").wait(60) == 0
    first = start("-c", KILLED, str(tmp_path))
    assert first.stdout is not None
    for line in first.stdout:
        if line.startswith("taking frames 8 "):
            os.kill(first.pid, signal.SIGKILL)
            break
    assert first.wait(60) == -signal.SIGKILL
    assert 0 < int(asked("Frame.objects.count()")) < 40
    second = start("-c", KILLED, str(tmp_path))
    assert second.communicate(timeout=120) and second.returncode == 0
    assert asked("Image.objects.count()") == "120"
    assert asked("sorted(Frame.objects.values_list('number', flat=True)) == list(range(0, 200, 5))") == "True"
    digests = "Image.objects.filter(camera__name='C2').values_list('full_digest', flat=True)"
    media = tmp_path / "killed" / "media"
    files = [
        media / storage_name(digest) for digest in asked(f"*{digests}.order_by('frame__number')").split()
    ]
    found = [number_in(cv2.imread(str(path))) for path in files]
    assert found == [15 * index for index in range(40)]
    assert list((tmp_path / "killed" / "unfinished").glob("videos-*/*")) == []


# Bounded


def test_only_a_part_of_the_pictures_exists_at_a_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_videos(tmp_path, 600)
    monkeypatch.setattr(importing, "INSTANTS_TOGETHER", 4)
    monkeypatch.setattr(importing, "SECONDS_BETWEEN_REPORTS", 0.001)
    most = 0

    def look(*_told: object) -> None:
        nonlocal most
        most = max(most, len(list((tmp_path / "data" / "unfinished").rglob("*.png"))))

    assert import_videos(video_options(tmp_path), look).frames_added == 40
    assert 0 < most <= 4 * len(NAMES)


def test_no_picture_is_held_once_its_file_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make_videos(tmp_path, 600)
    alive = most = 0
    lock = Lock()

    def counted(original: Callable[..., None]) -> Callable[..., None]:
        def made(self: Taken, *arguments: object) -> None:
            nonlocal alive, most
            with lock:
                alive += 1
                most = max(most, alive)
            original(self, *arguments)

        return made

    def gone(self: Taken) -> None:
        nonlocal alive
        with lock:
            alive -= 1

    monkeypatch.setattr(Taken, "__init__", counted(Taken.__init__))
    monkeypatch.setattr(Taken, "__del__", gone, raising=False)
    import_videos(video_options(tmp_path))
    assert most <= 2 * len(NAMES)
    assert alive == 0


def test_a_run_that_is_cancelled_leaves_whole_parts_and_no_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_videos(tmp_path, 600)
    monkeypatch.setattr(importing, "INSTANTS_TOGETHER", 4)

    def cancel(phase: str, done: int, _total: int) -> None:
        if phase == importing.PHASE and done >= 8:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        import_videos(video_options(tmp_path), cancel)
    assert Frame.objects.count() == 8 and Image.objects.count() == 24
    assert not (tmp_path / "data" / "unfinished" / "videos-square").exists()


# What is refused


def test_offsets_without_common_time_are_refused(tmp_path: Path) -> None:
    make_videos(tmp_path, 90)
    (problem,) = failure(tmp_path, 0.0, -5.0, 0.0)
    assert "C2 4.98 to 7.98 s" in problem


def test_everything_wrong_is_told_together(tmp_path: Path) -> None:
    make_videos(tmp_path, 30)
    (tmp_path / "C1.mp4").write_text("no video")
    make_video(tmp_path / "C3.mp4", 30, size=(640, 360))
    (tmp_path / "calibrations" / "extrinsic" / "extr_C2.xml").unlink()
    problems = "\n".join(failure(tmp_path))
    assert "C1.mp4: camera C1: no video that can be decoded" in problems
    assert "no file for camera C2" in problems
    assert "camera C3: the calibration has the middle of the image at (160, 120)" in problems


def test_a_size_the_calibration_states_is_insisted_on(tmp_path: Path) -> None:
    make_videos(tmp_path, 30)
    cameras_json(tmp_path)
    make_video(tmp_path / "C2.mp4", 30, size=(352, 240))
    (problem,) = failure(tmp_path, calibrations=tmp_path / "made.json")
    assert "camera C2: 320×240 pixels, but the images have 352×240" in problem


def test_a_camera_has_one_video_and_a_video_one_camera(tmp_path: Path) -> None:
    make_videos(tmp_path, 30)
    told = video_options(tmp_path)
    twice = (*told.sources[:2], told.sources[0])
    with pytest.raises(ImportFailed) as caught:
        import_videos(type(told)(told.dataset, twice))
    reasons = " ".join(problem.reason for problem in caught.value.problems)
    assert "camera C1 has 2 videos" in reasons and "is the video of 2 cameras" in reasons


# The command


def test_the_command_imports_and_tells(tmp_path: Path) -> None:
    make_videos(tmp_path, 90)
    out = io.StringIO()
    videos = [f"{name}={tmp_path / name}.mp4@0.0" for name in NAMES]
    words = ["square", str(tmp_path / "calibrations"), *videos, "--grid", "80x60", "--step", "0.1"]
    call_command("importvideos", *words, "--origin=-4,-3", "--from", "0.5", "--until", "2", stdout=out)
    assert "4 frames with 12 images added." in out.getvalue()
    assert list(Frame.objects.values_list("number", flat=True)) == [5, 10, 15, 20]
