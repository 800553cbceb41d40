"""Which submissions a person looks at: all of a newcomer, a share of whoever has earned trust.

One half of the share goes to the most suspicious, the other is drawn by chance among the rest. Without a
score all of it is chance.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import asdict, dataclass

from django.db.models import Max
from django.db.transaction import atomic
from django.utils.crypto import salted_hmac

from gtm_hit.models import Assignment, Campaign, ReviewChoice, Transition
from gtm_hit.ops.review.happened import Following, Happened
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.scores import suspicion as scores
from gtm_hit.ops.scores import words

log = logging.getLogger(__name__)

Why = ReviewChoice.Why

RECENT = 200  # submissions of the campaign that a score is ranked among
ALARM = 0.8  # a suspicion that is looked at whatever the share
DIGITS = 13  # hexadecimal ones, which a float holds exactly


@dataclass(frozen=True)
class ToldSuspicion:
    """How likely it is that work is bad, and why, in words for the reviewer."""

    score: float  # 0 to 1
    reasons: tuple[str, ...] = ()


def by_scores(assignment: Assignment) -> ToldSuspicion | None:
    if assignment.batch.campaign_id is None:
        return None
    found = scores.suspicion(assignment)
    reasons = (words.signal_in_words(asdict(signal)) for signal in found.signals)
    return ToldSuspicion(found.value, tuple(reasons))


# Each tells what it thinks of a submission, or None; the most suspicious one counts.
SOURCES: list[Callable[[Assignment], ToldSuspicion | None]] = [by_scores]


def after_submission(happened: Happened) -> Following | None:
    """An effect: what nobody is going to look at is accepted at once, and written down as that."""
    if happened.action is not Action.SUBMIT or happened.assignment.batch.qualification_id is not None:
        return None  # a try is judged by known truth
    choice = choose(happened.assignment)
    return None if choice.chosen else Following(Action.ACCEPT_UNSEEN, "not chosen for review")


def choose(assignment: Assignment) -> ReviewChoice:
    """Made once: work that comes back a second time is reviewed by whoever asked for it."""
    made = ReviewChoice.objects.filter(assignment=assignment).first()
    if made is not None:
        return made
    failed, suspicion = suspicion_of(assignment)
    why = Why.UNKNOWN if failed else reason_to_look(assignment, suspicion)
    return ReviewChoice.objects.create(
        assignment=assignment,
        chosen=why != Why.TRUSTED,
        why=why,
        suspicion=suspicion.score if suspicion else None,
        reasons=list(suspicion.reasons) if suspicion else [],
    )


def suspicion_of(assignment: Assignment) -> tuple[bool, ToldSuspicion | None]:
    """Whether a source failed, and the highest suspicion. A failing source stops nobody from submitting."""
    found: list[ToldSuspicion] = []
    try:
        with atomic():
            found = [one for source in SOURCES if (one := source(assignment))]
    except Exception:
        log.exception("the suspicion of assignment %s could not be told", assignment.pk)
        return True, None
    return False, max(found, key=lambda one: one.score, default=None)


def reason_to_look(assignment: Assignment, suspicion: ToldSuspicion | None) -> ReviewChoice.Why:
    campaign = assignment.batch.campaign
    if campaign is None or campaign.review_share >= 1.0:
        return Why.ALL
    if is_newcomer(assignment, campaign):
        return Why.NEWCOMER
    half = campaign.review_share / 2 if suspicion else 0.0
    if (
        suspicion
        and suspicion.score > 0
        and (suspicion.score >= ALARM or rank(assignment, campaign, suspicion.score) < half)
    ):
        return Why.SUSPICION
    # Of those who are left, so many that both together come to the share.
    return Why.CHANCE if chance(assignment) < (campaign.review_share - half) / (1.0 - half) else Why.TRUSTED


def is_newcomer(assignment: Assignment, campaign: Campaign) -> bool:
    """Trust takes so many batches that a person accepted, and a rejection makes it begin anew."""
    mine = Transition.objects.filter(
        assignment__worker=assignment.worker_id, assignment__batch__campaign=campaign, user__isnull=False
    )
    rejected = mine.filter(action=Action.REJECT).aggregate(last=Max("pk"))["last"] or 0
    seen = [Action.ACCEPT, Action.OVERTURN]
    accepted = mine.filter(action__in=seen, pk__gt=rejected).values("assignment").distinct().count()
    return accepted < campaign.newcomer_batches


def rank(assignment: Assignment, campaign: Campaign, score: float) -> float:
    """The share of the campaign's recent submissions that are at least as suspicious."""
    recent = ReviewChoice.objects.filter(assignment__batch__campaign=campaign, suspicion__isnull=False)
    scores = recent.order_by("-pk").values_list("suspicion", flat=True)[:RECENT]
    return sum(one is not None and one >= score for one in scores) / len(scores) if scores else 0.0


def chance(assignment: Assignment) -> float:
    """From 0 to below 1: the same for an assignment whenever it is asked, and known to this server only."""
    drawn = salted_hmac("gtm_hit.review.chance", str(assignment.pk), algorithm="sha256").hexdigest()
    return float(int(drawn[:DIGITS], 16) / 16**DIGITS)
