"""Telling the platform what is planned, row by row. Safe to run twice, and to be killed anywhere."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass
from decimal import Decimal
from typing import Any

from django.contrib.auth.models import User
from django.db.models import Q
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, Job, OutboxRow
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import Steps
from gtm_hit.ops.outbox import accounts, reconciling, rows, statuses
from gtm_hit.ops.outbox.platform import Bonus, NotSent, Platform, PlatformError, Refused, TooFast

State, Kind = OutboxRow.State, OutboxRow.Kind
Connect = Callable[[Campaign], Platform]
MOST_ATTEMPTS = 5
FIRST_WAIT, LONGEST_WAIT = 5.0, 900.0  # seconds until the same is sent again
WAITED_HERE = 20.0  # seconds; a platform that asks for more is left alone for now


@dataclass(frozen=True)
class Report:
    """How many rows a run confirmed, and how many are left in which state."""

    confirmed: int
    planned: int
    failed: int
    unclear: int
    sent: int


def start(campaign: Campaign, by: User | None = None) -> Job:
    parameters = {"campaign": campaign.pk, "name": campaign.name}
    return queue.create_once(Job.Kind.SEND_OUTBOX, campaign.dataset, parameters, by)


def run(mine: queue.Run, connect: Connect) -> dict[str, Any]:
    campaign = Campaign.objects.filter(pk=mine.job.parameters["campaign"]).first()
    if campaign is None:
        raise queue.JobError(_("The campaign is gone."))
    try:
        platform = connect(campaign)
    except accounts.AccountError as error:
        raise queue.JobError(str(error)) from error
    look(campaign, platform)
    return asdict(send(campaign, platform, lambda done, total: mine.report(done, total)))


def look(campaign: Campaign, platform: Platform) -> None:
    """What became of the submissions meanwhile; when it cannot be learnt now, the next run learns it."""
    if accounts.of(campaign).study:
        with suppress(PlatformError):
            statuses.ask_all(campaign, platform)


def resume(now: Any) -> list[Job]:
    """Go on where a run was broken off, or where the platform asked to wait."""
    begun = Q(state=State.SENT) | Q(state=State.PLANNED, not_before__lte=now)
    campaigns = Campaign.objects.filter(pk__in=OutboxRow.objects.filter(begun).values("campaign"))
    return [
        start(campaign) for campaign in campaigns.select_related("dataset", "account") if has_key(campaign)
    ]


def has_key(campaign: Campaign) -> bool:
    return accounts.has_key(accounts.of(campaign))


def send(campaign: Campaign, platform: Platform, steps: Steps) -> Report:
    """First what was lost is looked for, then what is planned is sent."""
    study = accounts.of(campaign).study
    before = count(campaign)[State.CONFIRMED]
    reconciling.reconcile(campaign, platform, study)
    total, done, seen = rows.due(campaign).count() * 2, 0, set[int]()
    while row := rows.due(campaign).exclude(pk__in=seen).first():
        steps(min(done, total), total)
        seen.add(row.pk)
        done += 1
        if not told(row, platform, study):
            break
        if rows.due(campaign).filter(pk=row.pk, attempts__lt=MOST_ATTEMPTS).exists():
            seen.discard(row.pk)  # it was asked to wait a little, and has
    counts = count(campaign)
    return Report(
        counts[State.CONFIRMED] - before,
        *(counts[state] for state in (State.PLANNED, State.FAILED, State.UNCLEAR, State.SENT)),
    )


def count(campaign: Campaign) -> dict[str, int]:
    states = list(OutboxRow.objects.filter(campaign=campaign).order_by().values_list("state", flat=True))
    return {state: states.count(state) for state in State.values}


def told(planned: OutboxRow, platform: Platform, study: str) -> bool:
    """Send one row and write down what came of it; False when the platform wants to be left alone."""
    try:
        known = {"before": seen_before(planned, platform, study)} if planned.kind == Kind.BONUS_PAY else {}
    except TooFast as error:
        return waited(planned, error)
    except Refused as error:
        rows.fail(planned, str(error))
        return True
    except PlatformError as error:
        rows.put_back(planned, str(error), wait_of(planned), attempts=planned.attempts + 1)
        return not isinstance(error, NotSent)
    row = rows.take(planned.pk, **known)
    if row is None:
        return True
    try:
        result = tell(row, platform, study)
    except TooFast as error:
        return waited(row, error)
    except Refused as error:
        refused(row, error, platform, study)
    except NotSent as error:
        again(row, str(error))
        return False
    except PlatformError as error:
        unanswered(row, error)
    else:
        rows.confirm(row.pk, result)
    return True


def tell(row: OutboxRow, platform: Platform, study: str) -> dict[str, Any]:
    match row.kind:
        case Kind.APPROVE:
            platform.approve(row.submission)
        case Kind.REJECT:
            platform.reject(row.submission, row.payload["message"], row.payload["category"])
        case Kind.REQUEST_RETURN:
            platform.request_return(row.submission, row.payload["reasons"])
        case Kind.BONUS_SETUP:
            amount = Decimal(row.payload["bonus"])
            return {"prepared": platform.set_up_bonuses(study, [Bonus(row.submission, amount)])}
        case Kind.BONUS_PAY:
            assert row.after is not None
            platform.pay_bonuses(row.after.result["prepared"])
    return {}


def seen_before(row: OutboxRow, platform: Platform, study: str) -> int:
    """How many bonuses of this amount there are already, so that one more can be told from them."""
    return reconciling.times(row, reconciling.bonuses(row, platform, study))


def waited(row: OutboxRow, error: TooFast) -> bool:
    tried = row.attempts if row.state == State.SENT else row.attempts + 1
    rows.put_back(row, str(error), error.seconds, attempts=tried)
    if error.seconds > WAITED_HERE:
        return False
    time.sleep(error.seconds)
    return True


def refused(row: OutboxRow, error: Refused, platform: Platform, study: str) -> None:
    """Perhaps because it is so already: somebody decided at the platform, or an earlier answer was lost."""
    if row.kind in reconciling.WANTED:
        try:
            status = platform.submission(row.submission).status
        except PlatformError:
            rows.leave_unclear(row, str(error))
            return
        if status == reconciling.WANTED[Kind(row.kind)]:
            rows.confirm(row.pk, {"status": status})
            return
    rows.fail(row, str(error))
    if row.kind == Kind.BONUS_SETUP:
        for paying in OutboxRow.objects.filter(after=row, state=State.PLANNED):
            rows.fail(paying, _("It could not be prepared: %(reason)s") % {"reason": error})


def unanswered(row: OutboxRow, error: PlatformError) -> None:
    """What pays is never sent again on suspicion: it stays `sent` until the platform tells."""
    row.result = {**row.result, "maybe": True}
    if row.kind == Kind.BONUS_PAY:
        OutboxRow.objects.filter(pk=row.pk, state=State.SENT).update(
            error=str(error)[:1000], result=row.result
        )
        return
    again(row, str(error))


def again(row: OutboxRow, error: str) -> None:
    if row.attempts < MOST_ATTEMPTS:
        rows.put_back(row, error, wait_of(row))
    elif row.result.get("maybe"):
        rows.leave_unclear(row, error)
    else:
        rows.fail(row, error)


def wait_of(row: OutboxRow) -> float:
    return min(FIRST_WAIT * 2 ** max(row.attempts - 1, 0), LONGEST_WAIT)


def next_wait(campaign: Campaign) -> float | None:
    """Seconds until something more can be sent; None when nothing waits."""
    later = OutboxRow.objects.filter(campaign=campaign, state=State.PLANNED, not_before__gt=timezone.now())
    first = later.order_by("not_before").values_list("not_before", flat=True).first()
    return (first - timezone.now()).total_seconds() if first else None
