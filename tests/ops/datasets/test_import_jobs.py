from __future__ import annotations

import io
import os
import shutil
import zipfile
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from django.core.management import CommandError, call_command
from django.utils import timezone

from gtm_hit.models import Dataset, Frame, Image, Job
from gtm_hit.ops.datasets import job as import_jobs
from gtm_hit.ops.datasets import rows
from gtm_hit.ops.files import sources
from gtm_hit.ops.files.picture_cleanup import remove_unused_pictures
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.archives import zipped
from tests.dataset_folder import NAMES, VALUES, make_folder
from tests.video_files import make_videos

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_folders(settings: Any, tmp_path: Path) -> None:
    settings.DATA_DIR = tmp_path / "data"
    settings.MEDIA_ROOT = tmp_path / "media"
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.INCOMING_ROOT = tmp_path / "incoming"
    settings.UPLOADS_ROOT = tmp_path / "uploads"


@pytest.fixture
def archive(tmp_path: Path) -> sources.Source:
    """An uploaded archive whose dataset lies in a folder of its own."""
    (tmp_path / "uploads").mkdir()
    folder = make_folder(tmp_path / "square")
    zipped(folder, tmp_path / "uploads" / "square.zip", below="Square v1")
    shutil.rmtree(folder)
    return sources.sources()[0]


def options(**changes: Any) -> dict[str, Any]:
    return {"slug": "square", "values": dict(VALUES), **changes}


def done(job: Job) -> Job:
    queue.run(job.pk, OPERATIONS)
    return Job.objects.get(pk=job.pk)


def test_an_uploaded_archive_becomes_a_dataset_and_goes(archive: sources.Source, tmp_path: Path) -> None:
    job = done(import_jobs.start_import(archive, options()))
    assert (job.state, job.dataset) == (Job.State.DONE, Dataset.objects.get(slug="square"))
    assert (job.result["frames"], job.result["images"], job.result["people"]) == (2, 6, 5)
    assert list((tmp_path / "uploads").iterdir()) == []


def test_a_folder_on_the_server_stays(tmp_path: Path) -> None:
    folder = make_folder(tmp_path / "incoming" / "plaza")
    job = done(import_jobs.start_import(sources.sources()[0], options()))
    assert job.state == Job.State.DONE and Frame.objects.count() == 2
    assert (folder / "Image_subsets" / "C1").is_dir()


def test_a_failed_import_lists_everything_and_keeps_the_upload(tmp_path: Path) -> None:
    folder = make_folder(tmp_path / "square")
    (folder / "Image_subsets" / "C1" / "00000005.png").unlink()
    (folder / "calibrations" / "extrinsic" / "extr_C2.xml").write_text("nothing")
    (tmp_path / "uploads").mkdir()
    zipped(folder, tmp_path / "uploads" / "square.zip")
    job = done(import_jobs.start_import(sources.sources()[0], options()))
    assert job.state == Job.State.FAILED
    first, *problems = job.message.splitlines()
    assert first == f"{len(problems)} problems; nothing was imported:" and len(problems) >= 2
    assert any(line.startswith("calibrations/extrinsic/extr_C2.xml") for line in problems)
    assert not Dataset.objects.exists() and job.dataset is None
    assert [path.name for path in (tmp_path / "uploads").iterdir()] == ["square.zip"]


@pytest.mark.parametrize("gone", ["", "Image_subsets", "calibrations", "annotations_positions"])
def test_no_message_tells_where_the_server_keeps_its_data(tmp_path: Path, settings: Any, gone: str) -> None:
    (tmp_path / "link").symlink_to(tmp_path)
    settings.DATA_DIR, settings.UPLOADS_ROOT = tmp_path / "link", tmp_path / "link" / "uploads"
    folder = make_folder(tmp_path / "square")
    (folder / "annotations_positions" / "00000005.json").write_text("damaged")
    shutil.move(folder / gone, tmp_path / "elsewhere") if gone else None
    (tmp_path / "uploads").mkdir()
    zipped(folder, tmp_path / "uploads" / "square.zip", below="d")
    named = {"annotations": "annotations_positions"} if gone == "annotations_positions" else {}
    parameters = {"source": "uploads/square.zip", "options": {**options(), **named}}
    job = done(queue.create(Job.Kind.IMPORT_DATASET, None, parameters))
    assert job.state == Job.State.FAILED and gone in job.message
    assert str(tmp_path) not in job.message


def test_trying_again_uses_the_same_upload(archive: sources.Source) -> None:
    failed = done(import_jobs.start_import(archive, options(preset="multiviewx", values={"columns": 3})))
    assert failed.state == Job.State.FAILED
    again = queue.retry(failed)
    assert (again.pk, again.parameters) != (failed.pk, {}) and again.parameters == failed.parameters


def test_an_import_of_something_gone_says_so(archive: sources.Source) -> None:
    job = import_jobs.start_import(archive, options())
    archive.path.unlink()
    assert done(job).message == "uploads/square.zip is no longer there."


def test_a_second_press_finds_the_same_job(archive: sources.Source) -> None:
    assert import_jobs.start_import(archive, options()) == import_jobs.start_import(archive, options())


def test_a_lost_worker_costs_nothing_but_time(archive: sources.Source, tmp_path: Path) -> None:
    job = import_jobs.start_import(archive, options())
    assert queue.claim(job.pk) is not None
    (tmp_path / "uploads" / f"unpacked-{job.pk}-1" / "half").mkdir(parents=True)
    Job.objects.update(state=Job.State.QUEUED)
    assert done(job).attempts == 2
    assert (Frame.objects.count(), Image.objects.count()) == (2, 6)


def test_a_cancelled_import_leaves_nothing(
    archive: sources.Source, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(queue, "SECONDS_BETWEEN_REPORTS", 0)
    job = import_jobs.start_import(archive, options())
    original = queue.Run.report

    def cancelling(self: queue.Run, done: int, total: int, message: str = "") -> None:
        if message.startswith("making images"):
            queue.cancel(job)
        original(self, done, total, message)

    monkeypatch.setattr(queue.Run, "report", cancelling)
    assert done(job).state == Job.State.CANCELLED
    assert not Dataset.objects.exists()
    assert [path.name for path in (tmp_path / "uploads").iterdir()] == ["square.zip"]
    remove_unused_pictures(timezone.now() + timedelta(days=1, minutes=1))
    assert not list((tmp_path / "media").rglob("*.jpg"))


def test_an_import_that_was_written_ends_as_done_though_its_worker_was_given_up(
    archive: sources.Source, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = import_jobs.start_import(archive, options())
    original = queue.Run.finish

    def too_late(self: queue.Run, result: dict[str, Any]) -> None:
        Job.objects.filter(attempts=1).update(state=Job.State.QUEUED)
        original(self, result)

    monkeypatch.setattr(queue.Run, "finish", too_late)
    assert done(job).state == Job.State.QUEUED
    again = done(job)
    assert (again.state, again.attempts, again.message) == (Job.State.DONE, 2, "")
    assert (again.result["frames"], again.dataset) == (2, Dataset.objects.get(slug="square"))
    assert not archive.path.exists()


def test_a_worker_killed_after_the_rows_were_written_leaves_nothing_to_do_but_tidy(
    archive: sources.Source, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = import_jobs.start_import(archive, options())

    class Killed(BaseException):
        pass

    def killed(*_told: object) -> None:
        raise Killed

    with monkeypatch.context() as patch, pytest.raises(Killed):
        patch.setattr(sources, "let_go", killed)
        done(job)
    assert archive.path.exists()
    Job.objects.update(heartbeat_at=None, cancel_requested=True, attempts=queue.MOST_ATTEMPTS)
    assert queue.requeue_lost(timezone.now()) == [job.pk]
    assert done(job).state == Job.State.DONE
    assert not archive.path.exists()


def test_a_worker_that_lost_its_import_before_it_was_written_writes_nothing(
    archive: sources.Source, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = import_jobs.start_import(archive, options())
    original = rows.add_frames

    def stopped_for_minutes(*values: Any) -> None:
        Job.objects.update(attempts=2)
        original(*values)

    monkeypatch.setattr(rows, "add_frames", stopped_for_minutes)
    ended = done(job)
    assert (ended.state, ended.result) == (Job.State.RUNNING, {})
    assert not Dataset.objects.exists()


def test_an_upload_stays_while_another_import_waits_for_it(archive: sources.Source) -> None:
    first, second = (import_jobs.start_import(archive, each) for each in (options(), options(slug="other")))
    assert done(first).state == Job.State.DONE
    assert archive.path.exists()
    assert done(second).state == Job.State.DONE
    assert not archive.path.exists()


def test_an_old_upload_stays_while_an_import_waits_for_it(archive: sources.Source) -> None:
    job = import_jobs.start_import(archive, options())
    os.utime(archive.path, (0, 0))
    sources.remove_leftovers()
    assert archive.path.exists()
    queue.cancel(job)
    sources.remove_leftovers()
    assert not archive.path.exists()


# Videos


@pytest.fixture
def videos(tmp_path: Path) -> sources.Source:
    make_videos(tmp_path / "incoming" / "walk", 60)
    return sources.sources()[0]


def start_videos(source: sources.Source, **changes: Any) -> Job:
    named = [import_jobs.VideoSource(name, Path(f"{name}.mp4"), 0.0) for name in NAMES]
    return import_jobs.start_videos(source, options(), named, **changes)


def test_videos_on_the_server_become_a_dataset(videos: sources.Source) -> None:
    job = done(start_videos(videos, start=0.5, until=1.5))
    assert job.state == Job.State.DONE and job.dataset is not None
    assert (job.result["frames"], job.result["images"]) == (3, 9)
    assert list(Frame.objects.values_list("number", flat=True)) == [5, 10, 15]


def test_suggested_videos_are_those_in_the_folder(videos: sources.Source) -> None:
    (videos.path / "notes.txt").touch()
    assert sources.videos(videos) == [Path(f"{name}.mp4") for name in NAMES]


@pytest.mark.parametrize("path", ["../secret.mp4", "/secret.mp4", "link.mp4"])
def test_videos_outside_the_folder_are_refused(videos: sources.Source, tmp_path: Path, path: str) -> None:
    shutil.copy(videos.path / "C1.mp4", tmp_path / "incoming" / "secret.mp4")
    (videos.path / "link.mp4").symlink_to(tmp_path / "incoming" / "secret.mp4")
    named = [import_jobs.VideoSource("C1", Path(path), 0.0)]
    job = done(import_jobs.start_videos(videos, options(), named))
    assert job.message == f"{path} does not lie in incoming/walk."
    assert not Dataset.objects.exists()


def test_the_command_takes_a_zip_as_well(tmp_path: Path) -> None:
    make_folder(tmp_path / "square")
    archive = shutil.make_archive(str(tmp_path / "square"), "zip", tmp_path, "square")
    scene = ("--grid", "80x60", "--step", "0.1", "--origin=-4,-3", "--frame-rate", "10", "--frame-step", "5")
    call_command("importdataset", "square", archive, *scene, stdout=io.StringIO())
    assert Dataset.objects.get().frames.count() == 2
    assert not list((tmp_path / "uploads").iterdir())


def test_the_command_refuses_a_zip_that_leads_out_of_its_folder(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "evil.zip", "w") as archive:
        archive.writestr("../evil", "x")
    told = io.StringIO()
    with pytest.raises(CommandError, match="1 problem; nothing was imported"):
        call_command("importdataset", "evil", str(tmp_path / "evil.zip"), stdout=io.StringIO(), stderr=told)
    assert "leads out of the archive" in told.getvalue()
    assert not Dataset.objects.exists()
