"""A campaign whose batches were done, accepted and are to be paid."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

from django.utils import timezone

from gtm_hit.models import (
    Assignment,
    Batch,
    Campaign,
    Dataset,
    Layer,
    LayerFrame,
    PlatformAccount,
    Worker,
)
from tests.prolific_server import TOKEN
from tests.work_scene import make_dataset, make_worker

State = Assignment.State


def make_campaign(dataset: Dataset | None = None, batches: int = 6, **values: Any) -> Campaign:
    """Ten frames a batch, 2.00 EUR each, 8.00 EUR an hour at least."""
    given = {"pay_per_batch": Decimal("2.00"), "hourly_floor": Decimal("8.00"), "currency": "EUR", **values}
    name = given.pop("name", "autumn")
    dataset = dataset or make_dataset(frames=10 * batches)
    campaign = Campaign.objects.create(dataset=dataset, name=name, state=Campaign.State.OPEN, **given)
    frames = list(dataset.frames.order_by("number"))
    for number in range(1, batches + 1):
        batch = Batch.objects.create(dataset=dataset, campaign=campaign, number=number)
        batch.frames.set(frames[10 * (number - 1) : 10 * number])
    return campaign


def prolific_campaign(**values: Any) -> Campaign:
    """With workers of the stand-in for Prolific, and the key to it."""
    campaign = make_campaign(platform=Campaign.Platform.PROLIFIC, **values)
    make_account(campaign, token=TOKEN)
    return campaign


def make_account(campaign: Campaign, address: str = "", token: str = "", **values: Any) -> PlatformAccount:
    given = {"study": "st1", **values}
    return PlatformAccount.objects.create(campaign=campaign, address=address, token=token, **given)


def assign(
    campaign: Campaign,
    worker: Worker,
    state: str = State.ACCEPTED,
    minutes: float = 12,
    submission: str = "",
) -> Assignment:
    """The next batch nobody has, in this state, with so many active minutes on its first frame."""
    batch = Batch.objects.filter(campaign=campaign, assignments__isnull=True).order_by("number")[0]
    name = f"batch-{campaign.name}-{batch.number:04d}"
    layer = Layer.objects.create(dataset=campaign.dataset, name=name, kind=Layer.Kind.ASSIGNMENT)
    frame = batch.frames.order_by("number")[0]
    LayerFrame.objects.create(layer=layer, frame=frame, revision=1, done=True, seconds=60 * minutes)
    now = timezone.now()
    return Assignment.objects.create(
        batch=batch,
        worker=worker,
        layer=layer,
        state=state,
        expires_at=now,
        submitted_at=None if state in {State.LEASED, State.EXPIRED} else now,
        submission=submission,
    )


def accepted_work(campaign: Campaign) -> Worker:
    """Ada's: a batch of half an hour, accepted, and nobody was told."""
    ada = make_worker("ada", "prolific")
    assign(campaign, ada, State.ACCEPTED, minutes=30, submission="s1")
    return ada


def become(assignment: Assignment, state: str) -> Assignment:
    Assignment.objects.filter(pk=assignment.pk).update(state=state, submitted_at=timezone.now())
    assignment.refresh_from_db()
    return assignment
