"""Marks of a dataset's cameras, remembered and compared; by job, page, REST and command."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import timedelta
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.management import CommandError, call_command
from django.test import Client
from django.utils import timezone

from gtm_hit.models import Dataset, DriftCheck, DriftMarks, Job
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.drift import checking, job, remembering
from gtm_hit.ops.drift.pictures import DriftRefused, Span
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.dataset_folder import cameras
from tests.ops.drift.scene import BY, FRAMES, KNOCKED, SINCE, knocked

pytestmark = pytest.mark.django_db
CALM = Span(0, SINCE - 1)


@pytest.fixture
def dataset(settings: Any, tmp_path: Path) -> Dataset:
    settings.MEDIA_ROOT, settings.TABLES_ROOT = tmp_path / "media", tmp_path / "tables"
    return knocked(tmp_path)


def states(check: DriftCheck) -> dict[str, str]:
    return {camera["camera"]: camera["state"] for camera in check.cameras}


def test_the_camera_that_was_knocked_is_named_with_the_frame_it_happened_in(dataset: Dataset) -> None:
    remembering.remember(dataset, CALM)
    found = checking.check_frames(dataset, Span())
    assert found.warns and found.frames == list(FRAMES)
    assert states(found) == {"C1": "steady", KNOCKED: "moved", "C3": "steady"}
    [moved] = [camera for camera in found.cameras if camera["camera"] == KNOCKED]
    assert moved["px"] == pytest.approx((BY[0] ** 2 + BY[1] ** 2) ** 0.5, abs=0.3)
    assert moved["since"] == SINCE and f"first seen in frame {SINCE}" in moved["verdict"]
    assert [frame for frame, px, _cm in moved["series"] if px > 2] == [
        each for each in FRAMES if each >= SINCE
    ]


def test_frames_before_it_are_steady_in_all_cameras(dataset: Dataset) -> None:
    remembering.remember(dataset, CALM)
    assert not checking.check_frames(dataset, Span(0, SINCE - 1, 2)).warns


def test_remembering_again_replaces_the_marks_and_keeps_other_calibrations(dataset: Dataset) -> None:
    remembering.remember(dataset, CALM)
    remembering.remember(dataset, Span(SINCE, None))
    assert DriftMarks.objects.count() == 3
    assert all(row.frames[0] == SINCE for row in remembering.remembered(dataset))
    assert not checking.check_frames(dataset, Span(SINCE, None)).warns


def test_without_marks_frames_or_pictures_it_is_said_what_to_do(dataset: Dataset) -> None:
    with pytest.raises(DriftRefused, match="Remember marks first"):
        job.start(dataset, Span())
    with pytest.raises(DriftRefused, match="No frame with pictures"):
        remembering.remember(dataset, Span(900, 950))
    with pytest.raises(CommandError, match="Remember marks first"):
        call_command("drift", "square")
    assert not Job.objects.filter(kind=Job.Kind.DRIFT).exists()


def test_a_job_taken_up_again_after_its_worker_was_killed_leaves_one_check(
    dataset: Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    remembering.remember(dataset, CALM)
    begun = job.start(dataset, Span())
    assert job.start(dataset, Span()).pk == begun.pk
    monkeypatch.setattr(checking.DriftCheck.objects, "update_or_create", killed)
    with pytest.raises(SystemExit):
        queue.run(begun.pk, OPERATIONS)
    monkeypatch.undo()
    Job.objects.filter(pk=begun.pk).update(heartbeat_at=timezone.now() - timedelta(hours=1), state="running")
    queue.requeue_lost(timezone.now())
    queue.run(begun.pk, OPERATIONS)
    mine = queue.claim(begun.pk)
    assert mine is None and Job.objects.get(pk=begun.pk).state == Job.State.DONE
    [check] = DriftCheck.objects.all()
    assert check.job_id == begun.pk and check.warns


def killed(**_values: object) -> None:
    raise SystemExit


def test_a_job_that_is_stopped_leaves_the_marks_there_were(
    dataset: Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = remembering.remember(dataset, CALM)
    begun = job.start(dataset, Span(SINCE, None), remember=True)
    choose = remembering.choose

    def stopped_meanwhile(pictures: Any) -> Any:
        queue.cancel(Job.objects.get(pk=begun.pk))
        return choose(pictures)

    monkeypatch.setattr(remembering, "choose", stopped_meanwhile)
    monkeypatch.setattr(queue, "SECONDS_BETWEEN_REPORTS", 0)
    queue.run(begun.pk, OPERATIONS)
    assert Job.objects.get(pk=begun.pk).state == Job.State.CANCELLED
    assert [row.pk for row in remembering.remembered(dataset)] == [row.pk for row in before]


def test_a_calibration_put_in_place_gets_marks_of_its_own_once(dataset: Dataset) -> None:
    old = remembering.remember(dataset, CALM)
    found = cameras()
    matrix = found[1].matrix.copy()
    matrix[0, 2] += 3
    found[1] = replace(found[1], matrix=matrix)
    _put_in_place(calibration_job.start(dataset, found))
    assert not remembering.remembered(dataset).exists()
    queue.run(Job.objects.get(kind=Job.Kind.DRIFT).pk, OPERATIONS)
    assert [row.calibration.number for row in remembering.remembered(dataset)] == [2, 2, 2]
    _put_in_place(calibration_job.start_version(dataset, 1))
    assert [row.pk for row in remembering.remembered(dataset)] == [row.pk for row in old]
    assert Job.objects.filter(kind=Job.Kind.DRIFT).count() == 1


def _put_in_place(comparison: Job) -> None:
    queue.run(comparison.pk, OPERATIONS)
    calibration_job.confirm(comparison)


def test_the_command_remembers_and_compares(dataset: Dataset) -> None:
    out = StringIO()
    call_command("drift", "square", "--remember", "--frames", f"0-{SINCE - 1}", stdout=out, stderr=StringIO())
    assert "C1: " in out.getvalue() and "marks from 8 frames" in out.getvalue()
    out = StringIO()
    call_command("drift", "square", "--every", "2", "--json", stdout=out, stderr=StringIO())
    found = json.loads(out.getvalue())
    assert found["warns"] and found["frames"] == list(FRAMES[::2])


def test_rest_starts_a_job_and_tells_what_it_found(dataset: Dataset, client: Client) -> None:
    client.force_login(User.objects.create_superuser("sam"))
    address = "/api/v1/datasets/square/drift/"
    refused = client.post(address, {"first": 9, "last": 3}, "application/json")
    assert refused.status_code == 400 and "before the first" in refused.content.decode()
    orders: list[dict[str, Any]] = [{"remember": True, "last": SINCE - 1}, {}]
    for order in orders:
        started = client.post(address, order, "application/json")
        assert started.status_code == 202
        queue.run(started.json()["id"], OPERATIONS)
    found = client.get(address).json()
    assert [each["camera"] for each in found["remembered"]] == ["C1", "C2", "C3"]
    assert found["checks"][0]["warns"] and found["checks"][0]["calibration"] == 1


def test_the_page_has_an_empty_state_then_verdicts_plots_and_arrows(dataset: Dataset, client: Client) -> None:
    client.force_login(User.objects.create_superuser("sam"))
    address = "/datasets/square/drift/"
    assert address in client.get("/datasets/square/calibration/").content.decode()
    assert "No marks are remembered" in client.get(address).content.decode()
    assert "Remember marks first" in client.post(address, {"every": 1, "do": "check"}).content.decode()
    for order in ({"do": "remember", "every": 1, "last": SINCE - 1}, {"do": "check", "every": 1}):
        queue.run(int(client.post(address, order)["Location"].strip("/").split("/")[-1]), OPERATIONS)
    last = Job.objects.filter(kind=Job.Kind.DRIFT).latest("pk")
    told = client.get(f"/jobs/{last.pk}/").content.decode()
    assert "A camera has moved." in told and f"{address}?check={last.result['check']}" in told
    page = client.get(address).content.decode()
    assert "a camera has moved" in page and "C2 has moved by 3.0 px" in page and "C1 is steady" in page
    assert page.count("<polyline") == 3 and page.count('class="arrows"') == 3
