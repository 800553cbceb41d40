"""Drafts follow their folder; a guess that is stopped leaves them as they are."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from django.utils import timezone

from gtm_hit.models import Job, VideoSync
from gtm_hit.ops.files import sources
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.sync import drafts, guessing, job, pictures
from gtm_hit.ops.sync.guessing import SyncRefused
from gtm_hit.ops.sync.state import Event
from gtm_hit.tasks import OPERATIONS
from tests.calibration.sync.test_sound import make_sound
from tests.sync_scene import opened_draft
from tests.video_files import make_uneven_video, make_video

pytestmark = pytest.mark.django_db


@pytest.fixture
def draft(settings: Any, tmp_path: Path) -> VideoSync:
    settings.DATA_DIR = tmp_path
    settings.INCOMING_ROOT, settings.UPLOADS_ROOT = tmp_path / "incoming", tmp_path / "uploads"
    return opened_draft(settings.INCOMING_ROOT)


def reopened() -> VideoSync:
    source = sources.source("incoming/plaza")
    assert source is not None
    return drafts.open_draft(source)


def set_and_marked(draft: VideoSync) -> VideoSync:
    state = drafts.current(draft)
    clocks = (state.clocks[0], replace(state.clocks[1], offset=1.5))
    return drafts.save(
        draft.pk, draft.revision, replace(state, clocks=clocks, events=(Event("door", {"C2.mp4": 1.0}),))
    )


def test_a_video_that_came_is_added_and_what_was_set_stays(draft: VideoSync, tmp_path: Path) -> None:
    set_and_marked(draft)
    make_video(tmp_path / "incoming" / "plaza" / "north side.mp4", 30)
    state = drafts.current(reopened())
    assert [(clock.camera, clock.offset) for clock in state.clocks] == [
        ("C1", 0.0),
        ("C2", 1.5),
        ("north-side", 0.0),
    ]
    assert state.events[0].name == "door"


def test_a_video_that_went_takes_its_marks_along_and_undoing_brings_no_other_one_back(
    draft: VideoSync, tmp_path: Path
) -> None:
    folder = tmp_path / "incoming" / "plaza"
    make_video(folder / "C3.mp4", 30)
    set_and_marked(draft)
    (folder / "C2.mp4").unlink()
    found = reopened()
    assert [clock.file for clock in drafts.current(found).clocks] == ["C1.mp4", "C3.mp4"]
    assert drafts.current(found).events == ()
    assert not drafts.steps(found).undo


def test_the_nearest_picture_of_an_uneven_video_is_found(draft: VideoSync, tmp_path: Path) -> None:
    path = make_uneven_video(tmp_path / "incoming" / "plaza" / "C9.mp4", [0, 40, 300, 340, 900])
    facts = {"start": 0.0, "interval": 0.04, "duration": 0.94, "version": "1"}
    asked = {150: 0.04, 200: 0.3, 330: 0.34, 700: 0.9}
    assert {at: round(pictures.picture(path, facts, at, 480).time, 3) for at in asked} == asked


def test_pictures_are_kept_for_a_day(draft: VideoSync, tmp_path: Path) -> None:
    path = tmp_path / "incoming" / "plaza" / "C1.mp4"
    pictures.picture(path, draft.facts[0], 400, 480)
    kept = list((tmp_path / "video-pictures").rglob("*-480"))
    assert len(kept) == pictures.TOGETHER
    pictures.remove_old(timezone.now())
    assert kept[0].exists()
    pictures.remove_old(timezone.now() + timedelta(days=2))
    assert not kept[0].exists()


def test_a_guess_stopped_in_the_middle_keeps_the_earlier_one_and_is_made_when_started_again(
    draft: VideoSync, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, began in (("C1", 0.0), ("C2", 3.125)):
        make_sound(tmp_path / "incoming" / "plaza" / f"{name}.wav", began)
    VideoSync.objects.update(guess={"told": "the one before"})
    read = guessing.read_sound

    def stopped_meanwhile(path: Path) -> Any:
        Job.objects.update(cancel_requested=True)
        return read(path)

    with monkeypatch.context() as patched:
        patched.setattr(guessing, "read_sound", stopped_meanwhile)
        first = job.start(draft)
        queue.run(first.pk, OPERATIONS)
    first.refresh_from_db()
    draft.refresh_from_db()
    assert (first.state, draft.guess) == (Job.State.CANCELLED, {"told": "the one before"})
    queue.run(queue.retry(first).pk, OPERATIONS)
    draft.refresh_from_db()
    assert draft.guess["places"][0]["offset"] == pytest.approx(3.125, abs=0.005)


def test_a_guess_of_an_earlier_set_of_videos_is_not_taken(draft: VideoSync) -> None:
    VideoSync.objects.update(guess={"places": [{"file": "gone.mp4", "offset": 1.0}]})
    with pytest.raises(SyncRefused, match="no guess of these videos"):
        drafts.take_guess(draft.pk, draft.revision)
