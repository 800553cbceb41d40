"""What the platform says about submissions, by message, by question or by file; late, twice, in any order."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime

from django.db import transaction
from django.utils import timezone

from gtm_hit.models import Assignment, Campaign, HookEvent, OutboxRow, Submission
from gtm_hit.ops.outbox import accounts, rows
from gtm_hit.ops.outbox.platform import Platform
from gtm_hit.ops.work import giving_back

FINAL = {"APPROVED", "REJECTED", Submission.RETURNED, "SCREENED OUT", "PARTIALLY APPROVED"}
LEFT = {Submission.RETURNED, "TIMED-OUT"}
DECIDED = {"APPROVED": OutboxRow.Kind.APPROVE, "REJECTED": OutboxRow.Kind.REJECT}
STATUS_CHANGE = "submission.status.change"


@dataclass(frozen=True)
class Told:
    """`at`: when it became so, by the platform's clock."""

    submission: str
    participant: str
    status: str
    at: datetime


def take_in(campaign: Campaign, event: str, kind: str, told: Told) -> bool:
    """A message of the platform; False when it changes nothing: it came before, or something newer did."""
    with transaction.atomic():
        _kept, new = HookEvent.objects.get_or_create(
            campaign=campaign, event_id=event, defaults={"kind": kind}
        )
        if kind != STATUS_CHANGE or not told.status:
            return False
        return new and observe(campaign, told)


def observe(campaign: Campaign, told: Told) -> bool:
    """Remember the newest status and do what follows from it; whether it was news."""
    with transaction.atomic():
        fresh = {"participant": told.participant, "status": told.status, "status_at": told.at}
        kept, made = Submission.objects.get_or_create(
            campaign=campaign, submission=told.submission, defaults=fresh
        )
        kept = Submission.objects.select_for_update(no_key=True).get(pk=kept.pk)
        before = "" if made else kept.status
        kept.status, kept.status_at = newest(kept.status, kept.status_at, told)
        kept.participant = told.participant or kept.participant
        kept.save(update_fields=["status", "status_at", "participant"])
        if kept.status == before:
            return False
        follow(campaign, told)
        return True


def newest(status: str, at: datetime, told: Told) -> tuple[str, datetime]:
    """What is decided stays so: a message that says otherwise is an old one, long under way."""
    if told.at < at or (status in FINAL and told.status not in FINAL):
        return status, at
    return told.status, told.at


def follow(campaign: Campaign, told: Told) -> None:
    if told.status in LEFT:
        giving_back.of_submission(campaign, told.submission, f"{told.status} at the platform")
    if kind := DECIDED.get(told.status):
        waiting = OutboxRow.objects.filter(
            campaign=campaign, submission=told.submission, kind=kind, state__in=rows.OPEN
        )
        for pk in waiting.values_list("pk", flat=True):
            rows.confirm(pk, {"status": told.status})


def ask_all(campaign: Campaign, platform: Platform) -> int:
    """Ask the platform for all submissions of the study; how many are news."""
    now = timezone.now()
    found = list(platform.submissions(accounts.of(campaign).study))
    return observe_all(
        campaign, (Told(each.submission, each.participant, each.status, now) for each in found)
    )


def observe_all(campaign: Campaign, found: Iterable[Told]) -> int:
    return sum(observe(campaign, told) for told in found)


def unmatched(campaign: Campaign) -> int:
    """Submissions the platform knows and nobody here worked under."""
    ours = Assignment.objects.filter(batch__campaign=campaign).exclude(submission="").values("submission")
    return Submission.objects.filter(campaign=campaign).exclude(submission__in=ours).count()
