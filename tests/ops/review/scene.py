"""Work that waits for its review, and the people who decide about it."""

from __future__ import annotations

from datetime import timedelta
from decimal import Decimal
from typing import Any

from django.contrib.auth.models import User
from django.utils import timezone

from gtm_hit.models import Assignment, Batch, Campaign, Dataset, Worker
from gtm_hit.ops.work.assignments import claim
from gtm_hit.ops.work.batches import make_batches
from gtm_hit.ops.work.pools import Pool
from tests.work_scene import finish, make_dataset, make_worker, row, save

REASON = "Half of the people in frames 5 and 10 are missing."
PLACES = [20_000, 40_100, 60_200, 80_300]  # positions of four people, metres apart


def make_reviewer(name: str = "rita") -> User:
    return User.objects.create_user(name, f"{name}@lab.example", is_superuser=True)


def make_work(frames: int = 4, size: int = 2, copies: int = 1, slug: str = "square") -> Dataset:
    dataset = make_dataset(slug, frames=frames)
    make_batches(dataset, size=size, copies=copies)
    return dataset


def into_campaign(dataset: Dataset, **rules: Any) -> Campaign:
    """All batches of the dataset, under these rules."""
    usual = {"name": "spring", "state": Campaign.State.OPEN, "pay_per_batch": Decimal("2.50")}
    campaign = Campaign.objects.create(dataset=dataset, **(usual | rules))
    Batch.objects.filter(dataset=dataset).update(campaign=campaign)
    return campaign


def annotate(assignment: Assignment, aside: int = 0, missing: int = 0) -> None:
    """Everybody in every frame, `aside` positions further, without the last `missing` ones."""
    places = PLACES[: len(PLACES) - missing]
    rows = [row(person, position + aside) for person, position in enumerate(places, start=1)]
    for frame in assignment.batch.frames.all():
        save(assignment.layer, frame, rows, author=assignment.worker, done=True)


def pool(dataset: Dataset) -> Pool:
    """The campaign all batches were put into, or the dataset itself."""
    return Pool(dataset, dataset.campaigns.first())


def submitted(worker: Worker | str, dataset: Dataset, **how: int) -> Assignment:
    """A batch annotated and handed in."""
    worker = make_worker(worker) if isinstance(worker, str) else worker
    assignment = claim(worker, pool(dataset))
    annotate(assignment, **how)
    return finish(assignment)


def run_out(assignment: Assignment) -> None:
    Assignment.objects.filter(pk=assignment.pk).update(expires_at=timezone.now() - timedelta(seconds=1))


def state(assignment: Assignment) -> str:
    return Assignment.objects.get(pk=assignment.pk).state
