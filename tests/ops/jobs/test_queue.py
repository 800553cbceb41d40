from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.utils import timezone

from gtm_hit.models import Dataset, Job
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.queue import JobCancelled, JobError, JobLost, Run

pytestmark = pytest.mark.django_db

KIND = Job.Kind.EXPORT_LAYER


@pytest.fixture
def dataset() -> Dataset:
    return Dataset.objects.create(slug="plaza", name="Plaza")


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Ids of the jobs a message was sent for."""
    ids: list[int] = []
    monkeypatch.setattr(queue, "_send", ids.append)
    return ids


def claimed(dataset: Dataset, **values: Any) -> Run:
    job = queue.create(KIND, dataset, {})
    run = queue.claim(job.pk)
    assert run is not None
    Job.objects.filter(pk=job.pk).update(**values)
    return run


def long_ago() -> datetime:
    return timezone.now() - timedelta(seconds=21)


def test_a_message_goes_out_only_when_the_row_is_committed(
    dataset: Dataset, sent: list[int], django_capture_on_commit_callbacks: Callable[..., Any]
) -> None:
    with django_capture_on_commit_callbacks() as callbacks:
        job = queue.create(KIND, dataset, {"layer": "a"})
    assert sent == []
    for callback in callbacks:
        callback()
    assert sent == [job.pk]


def test_a_dead_broker_does_not_disturb_whoever_starts_a_job(
    dataset: Dataset,
    monkeypatch: pytest.MonkeyPatch,
    django_capture_on_commit_callbacks: Callable[..., Any],
) -> None:
    def refuse(*args: Any, **kwargs: Any) -> None:
        raise OSError("connection refused")

    monkeypatch.setattr("gtm_hit.ops.jobs.queue.current_app.send_task", refuse)
    with django_capture_on_commit_callbacks(execute=True):
        job = queue.create(KIND, dataset, {})
    assert Job.objects.get(pk=job.pk).state == Job.State.QUEUED


def test_a_job_is_claimed_once(dataset: Dataset) -> None:
    job = queue.create(KIND, dataset, {})
    first = queue.claim(job.pk)
    assert first is not None and first.attempt == 1
    assert queue.claim(job.pk) is None
    job.refresh_from_db()
    assert (job.state, job.attempts) == (Job.State.RUNNING, 1)
    assert job.heartbeat_at is not None and job.started_at is not None


def test_reports_are_written_at_most_twice_a_second(
    dataset: Dataset, django_assert_num_queries: Callable[..., Any]
) -> None:
    run = claimed(dataset)
    seconds = iter([0.0, 0.0, 0.2, 0.4, 0.6, 0.6])
    run.clock = lambda: next(seconds)
    with django_assert_num_queries(2):
        for done in range(4):
            run.report(done, 10, "frames")
    job = Job.objects.get(pk=run.job.pk)
    assert (job.done, job.total, job.message) == (3, 10, "frames")


def test_a_report_is_a_sign_of_life(dataset: Dataset) -> None:
    run = claimed(dataset, heartbeat_at=long_ago())
    run.report(1, 2)
    assert queue.requeue_lost(timezone.now()) == []


def test_cancelling_a_waiting_job_ends_it_at_once(dataset: Dataset) -> None:
    job = queue.create(KIND, dataset, {})
    queue.cancel(job)
    job.refresh_from_db()
    assert job.state == Job.State.CANCELLED and job.finished_at is not None
    assert queue.claim(job.pk) is None


def test_a_running_job_learns_of_its_cancellation_at_its_next_report(dataset: Dataset) -> None:
    def operation(run: Run) -> dict[str, Any]:
        queue.cancel(run.job)
        with pytest.raises(JobCancelled):
            run.report(1, 2)
        run.report(1, 2)
        raise AssertionError("not reached")

    job = queue.create(KIND, dataset, {})
    queue.run(job.pk, {KIND: operation})
    job.refresh_from_db()
    assert job.state == Job.State.CANCELLED


def test_cancelling_a_finished_job_changes_nothing(dataset: Dataset) -> None:
    run = claimed(dataset)
    run.finish({"files": 3})
    queue.cancel(run.job)
    job = Job.objects.get(pk=run.job.pk)
    assert (job.state, job.cancel_requested) == (Job.State.DONE, False)


def test_the_result_is_kept_and_the_bar_is_full(dataset: Dataset) -> None:
    def operation(run: Run) -> dict[str, Any]:
        run.report(1, 7)
        return {"files": 3}

    job = queue.create(KIND, dataset, {})
    queue.run(job.pk, {KIND: operation})
    job.refresh_from_db()
    assert (job.state, job.result, job.done, job.total) == (Job.State.DONE, {"files": 3}, 7, 7)
    assert job.finished_at is not None


def test_a_foreseen_failure_says_only_its_reason(dataset: Dataset) -> None:
    def operation(run: Run) -> dict[str, Any]:
        raise JobError("The layer was deleted.")

    job = queue.create(KIND, dataset, {})
    queue.run(job.pk, {KIND: operation})
    job.refresh_from_db()
    assert (job.state, job.message) == (Job.State.FAILED, "The layer was deleted.")


def test_an_unforeseen_failure_ends_the_job_and_names_the_error(dataset: Dataset) -> None:
    def operation(run: Run) -> dict[str, Any]:
        raise KeyError("views")

    job = queue.create(KIND, dataset, {})
    queue.run(job.pk, {KIND: operation})
    job.refresh_from_db()
    assert (job.state, job.message) == (Job.State.FAILED, "KeyError: 'views'")


def test_a_silent_worker_loses_its_job_to_the_queue(
    dataset: Dataset, sent: list[int], django_capture_on_commit_callbacks: Callable[..., Any]
) -> None:
    run = claimed(dataset, heartbeat_at=long_ago())
    with django_capture_on_commit_callbacks(execute=True):
        assert queue.requeue_lost(timezone.now()) == [run.job.pk]
    job = Job.objects.get(pk=run.job.pk)
    assert (job.state, job.attempts, sent) == (Job.State.QUEUED, 1, [run.job.pk])


def test_whoever_lost_a_job_can_neither_report_nor_finish_it(dataset: Dataset) -> None:
    old = claimed(dataset, heartbeat_at=long_ago())
    queue.requeue_lost(timezone.now())
    new = queue.claim(old.job.pk)
    assert new is not None and new.attempt == 2
    with pytest.raises(JobLost):
        old.report(1, 2)
    with pytest.raises(JobLost):
        old.finish({})
    with pytest.raises(JobLost):
        old.fail("too late")
    assert Job.objects.get(pk=old.job.pk).state == Job.State.RUNNING


def test_a_worker_with_recent_signs_of_life_keeps_its_job(dataset: Dataset, sent: list[int]) -> None:
    run = claimed(dataset, heartbeat_at=timezone.now() - timedelta(seconds=19))
    assert queue.requeue_lost(timezone.now()) == []
    assert Job.objects.get(pk=run.job.pk).state == Job.State.RUNNING


def test_a_waiting_job_nobody_came_for_is_sent_again_once_per_interval(dataset: Dataset) -> None:
    job = queue.create(KIND, dataset, {})
    Job.objects.filter(pk=job.pk).update(heartbeat_at=long_ago())
    now = timezone.now()
    assert queue.requeue_lost(now) == [job.pk]
    assert queue.requeue_lost(now + timedelta(seconds=10)) == []
    assert queue.requeue_lost(now + timedelta(seconds=21)) == [job.pk]
    job.refresh_from_db()
    assert job.attempts == 0


def test_after_three_killed_workers_a_job_fails_and_says_where_and_why(dataset: Dataset) -> None:
    run = claimed(dataset, heartbeat_at=long_ago(), attempts=3, message="frames: 7 of 9")
    assert queue.requeue_lost(timezone.now()) == []
    job = Job.objects.get(pk=run.job.pk)
    assert job.state == Job.State.FAILED
    assert "killed 3 times, the last time at “frames: 7 of 9”" in job.message
    assert "too little memory" in job.message


def test_a_lost_job_that_was_to_be_cancelled_does_not_come_back(dataset: Dataset) -> None:
    run = claimed(dataset, heartbeat_at=long_ago(), cancel_requested=True)
    assert queue.requeue_lost(timezone.now()) == []
    assert Job.objects.get(pk=run.job.pk).state == Job.State.CANCELLED


def test_finished_jobs_are_left_alone(dataset: Dataset) -> None:
    run = claimed(dataset)
    run.finish({})
    Job.objects.update(heartbeat_at=long_ago())
    assert queue.requeue_lost(timezone.now()) == []
    assert Job.objects.get().state == Job.State.DONE


def test_a_second_press_finds_the_job_under_way(dataset: Dataset) -> None:
    first = queue.create_once(KIND, dataset, {"layer": "a"})
    assert queue.create_once(KIND, dataset, {"layer": "a"}) == first
    assert queue.create_once(KIND, dataset, {"layer": "b"}) != first


def test_trying_again_keeps_the_failed_job_and_its_reason(dataset: Dataset) -> None:
    user = User.objects.create_user("vera")
    run = claimed(dataset)
    run.fail("disk full")
    again = queue.retry(run.job, user)
    assert again.pk != run.job.pk
    assert (again.kind, again.state, again.created_by) == (KIND, Job.State.QUEUED, user)
    assert Job.objects.get(pk=run.job.pk).message == "disk full"


def test_a_kind_of_work_this_server_does_not_know_fails_at_once() -> None:
    job = queue.create(Job.Kind.MAKE_RELEASE, None, {})
    queue.run(job.pk, {})
    job.refresh_from_db()
    assert job.state == Job.State.FAILED
