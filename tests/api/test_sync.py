"""Clocks of videos over REST."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from gtm_hit.models import Job, VideoSync, VideoSyncState
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.api.conftest import Caller, bearer
from tests.calibration.sync.test_sound import make_sound
from tests.sync_scene import changed, make_folder
from tests.video_files import number_in

SYNCS = "/api/v1/video-syncs/"


@pytest.fixture(autouse=True)
def folder(settings: Any, tmp_path: Path) -> Path:
    settings.DATA_DIR = tmp_path
    settings.INCOMING_ROOT, settings.UPLOADS_ROOT = tmp_path / "incoming", tmp_path / "uploads"
    return make_folder(settings.INCOMING_ROOT)


@pytest.fixture
def whole(staff: Caller) -> dict[str, Any]:
    return staff.post(SYNCS, {"source": "incoming/plaza"}).json()


@pytest.fixture
def at(whole: dict[str, Any]) -> str:
    return f"{SYNCS}{whole['id']}/"


def offsets(whole: dict[str, Any]) -> list[float]:
    return [clock["offset"] for clock in whole["clocks"]]


def test_a_folder_has_one_draft_however_often_it_is_opened(staff: Caller, whole: dict[str, Any]) -> None:
    assert [(each["file"], each["width"]) for each in whole["videos"]] == [("C1.mp4", 320), ("C2.mp4", 320)]
    assert whole["videos"][1]["interval"] == pytest.approx(1001 / 30000, rel=1e-5)
    assert staff.post(SYNCS, {"source": "incoming/plaza"}).json() == whole
    assert VideoSync.objects.count() == 1


def test_a_saved_clock_is_undone_and_done_again(staff: Caller, whole: dict[str, Any], at: str) -> None:
    saved = staff.put(at, changed(whole, "C2", offset=1.25, drift=35.0)).json()
    assert offsets(saved) == [0.0, 1.25] and saved["undo"] and not saved["redo"]
    assert saved["lines"][1] == "C2 = C2.mp4 @ 1.2500+35.00ppm"
    undone = staff.post(f"{at}undo/", {"revision": saved["revision"]}).json()
    assert offsets(undone) == [0.0, 0.0] and undone["redo"] and not undone["undo"]
    again = staff.post(f"{at}redo/", {"revision": undone["revision"]}).json()
    assert offsets(again) == [0.0, 1.25]
    assert staff.client.get(f"{at}offsets.txt").content.decode().splitlines() == saved["lines"]


def test_who_saves_from_an_old_revision_is_told_what_it_is_now(
    staff: Caller, whole: dict[str, Any], at: str
) -> None:
    staff.put(at, changed(whole, "C2", offset=1.0))
    late = staff.put(at, changed(whole, "C1", offset=2.0))
    assert late.status_code == 412
    answer = late.json()
    assert answer["code"] == "stale" and "another window" in answer["message"]
    assert offsets(answer["details"]["current"]) == [0.0, 1.0] == offsets(staff.get(at).json())


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"drift": 20000.0}, "a drift of 20000 ppm is no clock's; the anchors do not fit"),
        ({"offset": 1e9}, "no video has an offset"),
        ({"camera": "C1"}, "Two videos have the name C1"),
        ({"camera": "C 2"}, "neither spaces nor ="),
        ({"file": "C3.mp4"}, "not the videos of this folder"),
    ],
)
def test_what_no_clock_can_be_is_refused_in_a_sentence(
    staff: Caller, whole: dict[str, Any], at: str, values: dict[str, Any], reason: str
) -> None:
    answer = staff.put(at, changed(whole, "C2", **values))
    assert answer.status_code == 400 and reason in answer.json()["details"][0]["reason"]
    assert VideoSyncState.objects.count() == 1


def test_a_picture_is_the_one_nearest_to_the_instant(staff: Caller, at: str) -> None:
    for query, number in (("at=1010", 30), ("frame=61", 61), ("at=999999", 89), ("at=-500", 0)):
        answer = staff.get(f"{at}videos/1/picture.jpg?{query}&width=480")
        assert number_in(cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_COLOR)) == number
        assert float(answer["X-Picture-Times"]) == pytest.approx(number * 1001 / 30000, abs=0.001)


def test_a_strip_has_pictures_one_below_the_other_as_far_as_the_video_goes(staff: Caller, at: str) -> None:
    answer = staff.get(f"{at}videos/0/strip.jpg?at=2600&step=200&count=5&width=480")
    assert answer["X-Picture-Times"].split() == ["2.600000", "2.800000"]
    pixels = cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_COLOR)
    assert [number_in(half) for half in np.vsplit(pixels, 2)] == [65, 70]


def test_pictures_of_no_video_and_without_an_instant_are_refused(
    staff: Caller, at: str, folder: Path
) -> None:
    assert staff.get(f"{at}videos/2/picture.jpg?at=0").status_code == 404
    assert staff.get(f"{at}videos/0/picture.jpg").status_code == 400
    assert staff.get(f"{at}videos/0/picture.jpg?at=0&width=123").status_code == 400
    (folder / "C1.mp4").unlink()
    assert staff.get(f"{at}videos/0/picture.jpg?at=0").status_code == 404
    assert staff.get(at).json()["problem"] == "C1.mp4 no longer lies in incoming/plaza."


def test_the_guess_is_a_job_and_sets_clocks_only_when_it_is_taken(
    staff: Caller, whole: dict[str, Any], at: str, folder: Path
) -> None:
    early = staff.post(f"{at}guess/take/", {"revision": whole["revision"]})
    assert early.json()["details"][0]["reason"] == "There is no guess of these videos yet."
    make_sound(folder / "C1.wav", 0.0)
    make_sound(folder / "C2.wav", 3.125)
    job = staff.post(f"{at}guess/").json()
    assert staff.get(at).json()["job"]["id"] == job["id"]
    queue.run(job["id"], OPERATIONS)
    found = staff.get(at).json()
    assert found["guess"]["basis"] == "sound" and offsets(found) == [0.0, 0.0] and found["job"] is None
    taken = staff.post(f"{at}guess/take/", {"revision": found["revision"]}).json()
    assert offsets(taken) == [pytest.approx(3.125, abs=0.005), 0.0]
    assert taken["reference"] == "C2.mp4"


def test_a_guess_is_stopped_like_any_job(staff: Caller, at: str) -> None:
    job = staff.post(f"{at}guess/").json()
    assert staff.post(f"/api/v1/jobs/{job['id']}/cancel/").json()["state"] == "cancelled"
    queue.run(job["id"], OPERATIONS)
    assert Job.objects.get().state == "cancelled" and staff.get(at).json()["guess"] == {}


def test_a_video_that_cannot_be_read_is_named(staff: Caller, folder: Path) -> None:
    (folder / "C3.mp4").write_bytes(b"no video")
    answer = staff.post(SYNCS, {"source": "incoming/plaza"})
    assert answer.status_code == 400
    assert answer.json()["details"] == [
        {"place": "source", "reason": "C3.mp4: no video that can be decoded."}
    ]


def test_a_token_needs_the_scope(at: str, whole: dict[str, Any]) -> None:
    assert bearer("read").put(at, changed(whole, "C2", offset=1.0)).status_code == 403
    assert bearer("read", "import").put(at, changed(whole, "C2", offset=1.0)).status_code == 200
