"""What came after the work of a large campaign: people, decisions, remarks, scores, money. Rows only."""

from __future__ import annotations

import random
from collections.abc import Iterator
from datetime import timedelta
from decimal import Decimal
from typing import Any

PEOPLE = 24  # in every frame
STEPS = {"accepted": "accept", "returned": "return", "rejected": "reject"}
REASON = "People behind the pillar are missing in half of the frames."
PARTS = [
    {"part": "found", "good": 400.0, "bad": 60.0, "lost": 6.0},
    {"part": "faults", "good": 9.0, "bad": 3.0, "lost": 4.0},
    {"part": "plausible", "good": 900.0, "bad": 12.0, "lost": 1.0},
    {"part": "identity", "good": 0.0, "bad": 0.0, "lost": 0.0},
]


def history(campaign: Any, frames: dict[int, list[int]]) -> None:
    """`frames`: their ids by batch."""
    from django.contrib.auth.models import User

    reviewer, _made = User.objects.get_or_create(username="rita")
    done = list(campaign_work(campaign))
    mark_people(done, frames)
    decide(done, reviewer)
    remark(done, frames, reviewer)
    score(campaign, done)
    book(campaign, done, reviewer)


def campaign_work(campaign: Any) -> Any:
    from gtm_hit.models import Assignment

    found = Assignment.objects.filter(batch__campaign=campaign, submitted_at__isnull=False)
    return found.select_related("batch").order_by("pk")


def mark_people(done: list[Any], frames: dict[int, list[int]]) -> None:
    """Everybody stands still; every worker is off by a way of their own and misses somebody now and then."""
    from gtm_hit.models import Annotation

    def rows() -> Iterator[Any]:
        for one in done:
            chance = random.Random(one.pk)
            aside = one.worker_id % 5 - 2
            for frame in frames[one.batch_id]:
                for person in range(1, PEOPLE + 1):
                    if chance.random() < 0.95:
                        position = 480 * 55 * person + 240 + aside
                        yield Annotation(
                            layer_id=one.layer_id, frame_id=frame, person=person, position=position
                        )

    Annotation.objects.bulk_create(rows(), batch_size=5000)


def decide(done: list[Any], reviewer: Any) -> None:
    from gtm_hit.models import Transition

    steps = []
    for one in done:
        steps.append(
            Transition(
                assignment=one,
                number=1,
                action="submit",
                from_state="leased",
                to_state="submitted",
                worker_id=one.worker_id,
            )
        )
        if one.state in STEPS:
            steps.append(
                Transition(
                    assignment=one,
                    number=2,
                    action=STEPS[one.state],
                    from_state="submitted",
                    to_state=one.state,
                    user=reviewer,
                    category="low_effort" if one.state == "rejected" else "",
                    reason="" if one.state == "accepted" else REASON,
                )
            )
    Transition.objects.bulk_create(steps)
    submitted = {one.pk: one.submitted_at for one in done}
    made = list(Transition.objects.filter(assignment__in=submitted))
    for step in made:
        step.at = submitted[step.assignment_id] + timedelta(hours=30 * (step.number - 1))
    Transition.objects.bulk_update(made, ["at"], batch_size=500)


def remark(done: list[Any], frames: dict[int, list[int]], reviewer: Any) -> None:
    from django.utils import timezone

    from gtm_hit.models import Comment

    texts = ["Two steps to the left.", "Nobody stands there.", "The same person as number 7 before."]
    Comment.objects.bulk_create(
        Comment(
            assignment=one,
            frame_id=frames[one.batch_id][nth],
            person=nth + 1,
            text=text,
            user=reviewer,
            resolved_at=timezone.now() if nth == 0 else None,
        )
        for one in done
        if one.state == "returned" or (one.state == "accepted" and one.pk % 2)
        for nth, text in enumerate(texts)
    )


def score(campaign: Any, done: list[Any]) -> None:
    from django.utils import timezone

    from gtm_hit.models import AssignmentScore, WorkerScore

    now = timezone.now()
    AssignmentScore.objects.bulk_create(
        AssignmentScore(assignment=one, evidence={}, suspicion=one.pk % 100 / 100, computed_at=now)
        for one in done
    )
    count: dict[int, int] = {}
    for one in done:
        count[one.worker_id] = count.get(one.worker_id, 0) + 1
    WorkerScore.objects.bulk_create(
        WorkerScore(
            campaign=campaign,
            worker_id=worker,
            score=60 + worker % 37,
            low=45 + worker % 37,
            high=63 + worker % 37,
            assignments=number,
            reasons=PARTS,
            computed_at=now,
        )
        for worker, number in count.items()
    )


def book(campaign: Any, done: list[Any], reviewer: Any) -> None:
    """What accepted batches earned; every third worker was paid, every fifth got a bonus."""
    from gtm_hit.models import MoneyEntry
    from gtm_hit.ops.pay import ledger

    with ledger.holding(campaign) as held:
        ledger.settle(held)
    workers = sorted({one.worker_id for one in done if one.state == "accepted"})
    lines = [(worker, "paid", Decimal("2.00")) for worker in workers[::3]]
    lines += [(worker, "bonus_approved", Decimal("0.45")) for worker in workers[::5]]
    MoneyEntry.objects.bulk_create(
        MoneyEntry(
            campaign=campaign,
            worker_id=worker,
            kind=kind,
            amount=amount,
            currency=campaign.currency,
            key=f"bench:{kind}:{campaign.pk}:{worker}",
            user=reviewer,
        )
        for worker, kind, amount in lines
    )
