"""Signed addresses: what a link entitles its holder to, and how long."""

from __future__ import annotations

import secrets
from dataclasses import dataclass
from datetime import timedelta
from typing import Any

from django.conf import settings
from django.db import transaction
from django.utils import timezone

from gtm_hit.models import Assignment, Campaign, CampaignLink, Dataset, Worker
from gtm_hit.models.work import nonce as new_nonce
from gtm_hit.ops.campaigns import links as campaign_links
from gtm_hit.ops.work import entry_links, workers
from gtm_hit.ops.work.pools import Pool
from gtm_hit.ops.work.signing import BadToken, sign, sign_dated, unsign, unsign_dated

__all__ = ["BadToken", "unsign"]


@dataclass(frozen=True)
class Entry:
    """The way into a dataset's or a campaign's work; a personal link names the worker too."""

    dataset: Dataset
    platform: str
    external_id: str | None
    closed: bool = False  # to new people
    link: CampaignLink | None = None

    @property
    def campaign(self) -> Campaign | None:
        return self.link.campaign if self.link else None


@dataclass(frozen=True)
class Seat:
    """A worker at one dataset or campaign, with what his platform wants to hear when he leaves."""

    worker: Worker
    dataset: Dataset
    campaign: Campaign | None = None
    submission: str = ""
    submit_to: str = ""

    @property
    def pool(self) -> Pool:
        return Pool(self.dataset, self.campaign, self.submission)


@dataclass(frozen=True)
class Task:
    """An assignment, opened from a seat that knows where the last form goes."""

    assignment: Assignment
    submit_to: str = ""

    @property
    def seat(self) -> Seat:
        batch = self.assignment.batch
        submission = self.assignment.submission
        return Seat(self.assignment.worker, batch.dataset, batch.campaign, submission, self.submit_to)


def entry_token(dataset: Dataset, platform: str = "link", external_id: str | None = None) -> str:
    if external_id:
        worker = workers.find(platform, external_id)
        own = [worker.nonce] if worker and worker.nonce else []
        return sign_dated("entry", [dataset.pk, platform, external_id, *own])
    nonce = entry_links.state(dataset, platform).nonce
    return sign_dated("entry", [dataset.pk, platform, *(["", nonce] if nonce else [])])


def read_entry(token: str) -> Entry:
    """Of a dataset's link, or a campaign's. Raises BadToken."""
    try:
        dataset_id, platform, *more = unsign_dated("entry", token)
    except BadToken:
        return campaign_entry(campaign_links.find(token))
    dataset = Dataset.objects.filter(pk=dataset_id).first()
    if dataset is None:
        raise BadToken("the dataset is gone")
    external_id, nonce = [*more, "", ""][:2]
    if external_id:
        unsign_dated("entry", token, settings.WORKER_LINK_DAYS)
        worker = workers.find(platform, external_id)
        if (worker.nonce if worker else "") != nonce:
            raise BadToken("the worker's links were revoked")
        return Entry(dataset, platform, external_id)
    link = entry_links.state(dataset, platform)
    closed = link.closed_at is not None or link.nonce != nonce or too_old(token)
    return Entry(dataset, platform, None, closed)


def too_old(token: str) -> bool:
    """Whoever began through it goes on; nobody new comes in."""
    try:
        unsign_dated("entry", token, settings.ENTRY_LINK_DAYS)
    except BadToken:
        return True
    return False


def campaign_entry(link: CampaignLink) -> Entry:
    campaign = link.campaign
    if link.kind == CampaignLink.Kind.INVITATION:
        raise BadToken("an invitation opens no batches")
    if link.worker is None:
        return Entry(campaign.dataset, campaign.platform, None, link.state != "open", link)
    if link.state != "open":
        raise BadToken("the personal link was revoked or is over")
    return Entry(campaign.dataset, campaign.platform, link.worker.external_id, False, link)


BLANK = [0, 0, "", 0, "", ""]  # what is left out at the end of a seat's token


def worker_token(worker: Worker, dataset: Dataset) -> str:
    return seat_token(Seat(worker, dataset))


def seat_token(seat: Seat) -> str:
    content = [seat.worker.pk, seat.dataset.pk, seat.worker.nonce]
    if seat.campaign:
        content += [seat.campaign.pk, seat.submission, seat.submit_to]
    while not content[-1]:
        content.pop()
    return sign_dated("worker", content)


def read_worker(token: str) -> Seat:
    content = unsign_dated("worker", token, settings.WORKER_LINK_DAYS)
    filled: list[Any] = content + BLANK[len(content) :]
    worker_id, dataset_id, nonce, campaign_id, submission, submit_to = filled
    worker = Worker.objects.filter(pk=worker_id, nonce=nonce).first()
    dataset = Dataset.objects.filter(pk=dataset_id).first()
    if worker is None or dataset is None:
        raise BadToken("the worker or the dataset is gone, or his links were revoked")
    if not campaign_id:
        return Seat(worker, dataset)
    campaign = Campaign.objects.select_related("dataset").filter(pk=campaign_id, dataset=dataset).first()
    if campaign is None:
        raise BadToken("the campaign is gone")
    return Seat(worker, dataset, campaign, submission, submit_to)


def assignment_token(assignment: Assignment, submit_to: str = "") -> str:
    return sign("assignment", [assignment.pk, assignment.nonce, *([submit_to] if submit_to else [])])


def read_task(token: str) -> Task:
    assignment_id, nonce, *more = unsign("assignment", token)
    rows = Assignment.objects.select_related(
        "batch__dataset", "batch__campaign__dataset", "worker", "layer__dataset"
    )
    assignment = rows.filter(pk=assignment_id, nonce=nonce).first()
    if assignment is None:
        raise BadToken("the assignment is gone or its link was revoked")
    if long_over(assignment):
        raise BadToken("the assignment was over long ago")
    return Task(assignment, *more)


def long_over(assignment: Assignment) -> bool:
    """Work that may go on keeps its address; what is over loses it like every other link of the worker."""
    days = settings.WORKER_LINK_DAYS
    if not days or assignment.editable:
        return False
    return (assignment.submitted_at or assignment.expires_at) < timezone.now() - timedelta(days=days)


def read_assignment(token: str) -> Assignment:
    return read_task(token).assignment


def revoke_assignment(assignment: Assignment) -> None:
    """Its address is worth nothing from now on; the worker gets a new one from his start page."""
    Assignment.objects.filter(pk=assignment.pk).update(nonce=new_nonce())


def revoke_worker(worker: Worker) -> None:
    """Whatever led to his pages and batches is worth nothing; the browser he began in is forgotten too."""
    with transaction.atomic():
        Worker.objects.filter(pk=worker.pk).update(nonce=secrets.token_hex(8), browser="")
        CampaignLink.objects.filter(worker=worker, revoked_at=None).update(revoked_at=timezone.now())
        for assignment in Assignment.objects.filter(worker=worker):
            revoke_assignment(assignment)
