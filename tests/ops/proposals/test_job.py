"""Proposing as a job."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest

from gtm_hit import tasks
from gtm_hit.models import Dataset, Image, Job, Proposal
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.proposals import from_files, job, looking, runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.job import Order
from gtm_hit.ops.work import batches
from tests.ops.proposals.conftest import NUMBERS
from tests.ops.proposals.watcher import Watcher, walk


@pytest.fixture
def watcher(dataset: Dataset, monkeypatch: pytest.MonkeyPatch) -> Watcher:
    made = Watcher(dataset, walk(NUMBERS))
    monkeypatch.setattr(looking, "looker", lambda *_order: made)
    return made


def test_a_job_proposes_and_its_people_are_shown(dataset: Dataset, watcher: Watcher) -> None:
    started = job.start(dataset, Order())
    tasks.run_job(started.pk)
    started.refresh_from_db()
    assert started.state == Job.State.DONE, started.message
    assert started.result == {
        "run": runs.runs(dataset)[0].pk,
        "frames": 8,
        "known": 0,
        "people": 8,
        "tracks": 1,
    }
    assert runs.in_use(dataset) is not None


def test_a_cancelled_job_keeps_what_it_has_and_another_goes_on(
    dataset: Dataset, watcher: Watcher, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(queue, "SECONDS_BETWEEN_REPORTS", 0.0)
    started = job.start(dataset, Order())
    watcher.before = lambda number: queue.cancel(started) if number == 15 else None
    tasks.run_job(started.pk)
    started.refresh_from_db()
    assert started.state == Job.State.CANCELLED
    assert watcher.looked == [0, 5, 10, 15]
    watcher.before = lambda number: None
    tasks.run_job(job.start(dataset, Order()).pk)
    assert watcher.looked == list(NUMBERS)
    assert Proposal.objects.count() == 8


@pytest.mark.parametrize(
    "order", [Order(method="magic"), Order(method="file"), Order(detector="/etc/passwd")]
)
def test_what_the_server_does_not_offer_starts_nothing(dataset: Dataset, order: Order) -> None:
    with pytest.raises(ProposalError):
        job.start(dataset, order)
    assert not Job.objects.exists()


def test_a_listed_address_may_be_asked_for(dataset: Dataset, settings: Any) -> None:
    settings.DETECTOR_ADDRESSES = ["http://10.0.0.7:8080"]
    assert job.start(dataset, Order(detector="http://10.0.0.7:8080")).kind == Job.Kind.PROPOSE


def test_cutting_batches_starts_proposing_once(dataset: Dataset, settings: Any) -> None:
    settings.PROPOSE_AUTOMATICALLY = True
    batches.make_batches(dataset, size=4)
    batches.make_batches(dataset, size=4)
    assert Job.objects.filter(kind=Job.Kind.PROPOSE).count() == 1


def test_nothing_starts_by_itself_where_everything_is_proposed(
    dataset: Dataset, watcher: Watcher, settings: Any
) -> None:
    job.do(dataset, Order())
    settings.PROPOSE_AUTOMATICALLY = True
    batches.make_batches(dataset, size=4)
    assert not Job.objects.exists()


def test_nothing_starts_without_pictures_or_where_it_is_switched_off(dataset: Dataset, settings: Any) -> None:
    batches.make_batches(dataset, size=4)
    settings.PROPOSE_AUTOMATICALLY = True
    Image.objects.all().delete()
    batches.make_batches(dataset, size=4, copies=2)
    assert not Job.objects.exists()


def test_a_file_of_another_program_lands_in_the_same_proposals(dataset: Dataset, tmp_path: Path) -> None:
    file = tmp_path / "found.csv"
    lines = io.StringIO("frame,person,x,y\n")
    lines.seek(0, io.SEEK_END)
    for at, number in enumerate(NUMBERS):
        lines.write(f"{number},{at},{0.3 * at},0\n")
    file.write_text(lines.getvalue())
    run, found = from_files.take_in(dataset, file, "csv")
    assert (run.method, found.frames, found.people, found.tracks) == ("file", 8, 8, 1)
    again, _found = from_files.take_in(dataset, file, "csv")
    assert again == run
    assert Proposal.objects.count() == 8


def test_a_broken_file_proposes_nothing_and_says_where(dataset: Dataset, tmp_path: Path) -> None:
    file = tmp_path / "found.csv"
    file.write_text("frame,person,x,y\n0,1,east,0\n")
    with pytest.raises(ProposalError, match="line 2"):
        from_files.take_in(dataset, file, "csv")
    assert not runs.runs(dataset).exists()
