"""The page that lays videos side by side, and the way from it into the import."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.test import Client

from gtm_hit.models import Job, VideoSync
from gtm_hit.ops.sync import drafts
from gtm_hit.ops.sync.state import Clock, State
from tests.sync_scene import make_folder
from tests.video_files import make_video


@pytest.fixture
def staff(db: None, settings: Any, tmp_path: Path) -> Client:
    settings.DATA_DIR = tmp_path
    settings.INCOMING_ROOT, settings.UPLOADS_ROOT = tmp_path / "incoming", tmp_path / "uploads"
    client = Client()
    client.force_login(User.objects.create_user("sam", is_superuser=True))
    return client


def text(response: Any) -> str:
    return response.content.decode()


def test_without_videos_the_page_says_where_to_put_them(staff: Client, tmp_path: Path) -> None:
    assert str(tmp_path / "incoming") in text(staff.get("/video-syncs/"))


def test_opening_a_folder_for_the_first_time_starts_the_guess(staff: Client, tmp_path: Path) -> None:
    make_folder(tmp_path / "incoming")
    assert "Lay side by side" in text(staff.get("/video-syncs/"))
    opened = staff.post("/video-syncs/", {"source": "incoming/plaza"})
    draft = VideoSync.objects.get()
    assert opened["Location"] == f"/video-syncs/{draft.pk}/"
    assert Job.objects.get().parameters["sync"] == draft.pk
    assert "incoming/plaza" in text(staff.get(opened["Location"]))
    drafts.save(draft.pk, draft.revision, drafts.current(draft))
    Job.objects.all().delete()
    staff.post("/video-syncs/", {"source": "incoming/plaza"})
    assert not Job.objects.exists()


def test_a_folder_of_one_video_is_told_so(staff: Client, tmp_path: Path) -> None:
    make_video(tmp_path / "incoming" / "alone" / "C1.mp4", 10)
    assert "one video has nothing to be laid beside" in text(staff.get("/video-syncs/"))
    page = text(staff.post("/video-syncs/", {"source": "incoming/alone"}, follow=True))
    assert "fewer than two videos" in page and not VideoSync.objects.exists()


def test_the_import_opens_with_the_offsets_filled_in(staff: Client, tmp_path: Path) -> None:
    make_folder(tmp_path / "incoming")
    staff.post("/video-syncs/", {"source": "incoming/plaza"})
    draft = VideoSync.objects.get()
    clocks = (Clock("C1.mp4", "C1", 0.48), Clock("C2.mp4", "north", -1.25, 35.0))
    drafts.save(draft.pk, draft.revision, State(clocks))
    page = text(staff.get(f"/imports/videos/?sync={draft.pk}"))
    assert "C1 = C1.mp4 @ 0.4800\nnorth = C2.mp4 @ -1.2500+35.00ppm" in page
    assert 'value="incoming/plaza" selected' in page
