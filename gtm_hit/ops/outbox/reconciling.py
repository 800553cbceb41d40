"""Rows whose answer was lost: the platform is asked what became of them. Nothing is paid here, ever."""

from __future__ import annotations

from collections.abc import Callable
from datetime import timedelta
from decimal import Decimal

from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, OutboxRow
from gtm_hit.ops.outbox import rows
from gtm_hit.ops.outbox.platform import Platform, PlatformError, TooFast

State, Kind = OutboxRow.State, OutboxRow.Kind
WANTED = {Kind.APPROVE: "APPROVED", Kind.REJECT: "REJECTED"}
PENDING = {"AWAITING REVIEW", "ACTIVE", "RESERVED", "PROCESSING", "TIMED-OUT"}
BOOKED_AFTER = timedelta(minutes=20)  # Prolific pays within minutes of its answer


def reconcile(campaign: Campaign, platform: Platform, study: str) -> int:
    """Ask about everything that is sent or unclear; how many are confirmed by it."""
    lost = OutboxRow.objects.filter(campaign=campaign, state__in=[State.SENT, State.UNCLEAR])
    before = OutboxRow.objects.filter(campaign=campaign, state=State.CONFIRMED).count()
    for row in lost.select_related("campaign").order_by("pk"):
        try:
            ask(row, platform, study)
        except TooFast:
            break
        except PlatformError as error:
            OutboxRow.objects.filter(pk=row.pk, state=row.state).update(error=str(error)[:1000])
    return OutboxRow.objects.filter(campaign=campaign, state=State.CONFIRMED).count() - before


def ask(row: OutboxRow, platform: Platform, study: str) -> None:
    about: dict[str, Callable[[OutboxRow, Platform, str], None]] = {
        Kind.APPROVE: about_decision,
        Kind.REJECT: about_decision,
        Kind.REQUEST_RETURN: about_return,
        Kind.BONUS_SETUP: about_setup,
        Kind.BONUS_PAY: about_payment,
    }
    about[row.kind](row, platform, study)


def about_decision(row: OutboxRow, platform: Platform, _study: str) -> None:
    status = platform.submission(row.submission).status
    if status == WANTED[Kind(row.kind)]:
        rows.confirm(row.pk, {"status": status})
    elif status in PENDING:
        rows.put_back(row, _("The platform never got it."))
    else:
        rows.fail(row, _("The submission is %(status)s at the platform.") % {"status": status})


def about_return(row: OutboxRow, platform: Platform, _study: str) -> None:
    if platform.submission(row.submission).return_requested:
        rows.confirm(row.pk, {})
    else:
        rows.put_back(row, _("The platform never got it."))


def about_setup(row: OutboxRow, _platform: Platform, _study: str) -> None:
    rows.put_back(row, _("Its answer was lost; a bonus that is prepared twice is not paid twice."))


def about_payment(row: OutboxRow, platform: Platform, study: str) -> None:
    """One more bonus of this amount than before, and than we know of, is this one."""
    there = times(row, bonuses(row, platform, study))
    known = OutboxRow.objects.filter(
        kind=Kind.BONUS_PAY, submission=row.submission, amount=row.amount, state=State.CONFIRMED
    ).count()
    if there > max(int(row.payload.get("before", 0)), known):
        rows.confirm(row.pk, {"found": True})
    elif row.sent_at is None or timezone.now() - row.sent_at > BOOKED_AFTER:
        words = _("The platform shows no such bonus. Look there before anything is paid again.")
        rows.leave_unclear(row, words)


def bonuses(row: OutboxRow, platform: Platform, study: str) -> list[Decimal]:
    """Of the row's submission, or of all submissions of its participant."""
    if row.payload.get("is_submission"):
        return list(platform.submission(row.submission).bonuses)
    mine = (each for each in platform.submissions(study) if each.participant == row.submission)
    return [bonus for each in mine for bonus in each.bonuses]


def times(row: OutboxRow, found: list[Decimal]) -> int:
    return found.count(row.amount)
