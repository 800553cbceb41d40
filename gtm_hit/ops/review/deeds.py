"""What steps of the machine do besides changing the state."""

from __future__ import annotations

from django.db.models import Max
from django.utils import timezone

from gtm_hit.models import Appeal, Assignment, Batch, Mend
from gtm_hit.models.work import completion_code
from gtm_hit.ops.review.asked import Asked
from gtm_hit.ops.review.needs import batch_taken


def give_code(asked: Asked) -> None:
    code = asked.assignment.code or completion_code()
    asked.changes |= {"submitted_at": timezone.now(), "code": code}


def end_lease(asked: Asked) -> None:
    asked.changes |= {"expires_at": timezone.now()}


def use_mend(asked: Asked) -> None:
    Mend.objects.filter(assignment=asked.assignment).update(accepted_at=timezone.now())


def open_appeal(asked: Asked) -> None:
    Appeal.objects.create(assignment=asked.assignment, text=asked.reason)


def uphold(asked: Asked) -> None:
    decide(asked, Appeal.Outcome.UPHELD)


def overturn(asked: Asked) -> None:
    """Where somebody else has the batch meanwhile, the work becomes one more copy of it."""
    decide(asked, Appeal.Outcome.OVERTURNED)
    if batch_taken(asked.assignment):
        asked.changes["batch"] = further_copy(asked.assignment)


def decide(asked: Asked, outcome: Appeal.Outcome) -> None:
    Appeal.objects.filter(assignment=asked.assignment).update(
        outcome=outcome, answer=asked.reason, decided_by=asked.by, decided_at=timezone.now()
    )


def further_copy(assignment: Assignment) -> Batch:
    batch = assignment.batch
    same = Batch.objects.filter(dataset=batch.dataset_id, campaign=batch.campaign_id, number=batch.number)
    last = same.aggregate(last=Max("copy"))["last"] or 0
    made = Batch.objects.create(
        dataset_id=batch.dataset_id, campaign_id=batch.campaign_id, number=batch.number, copy=last + 1
    )
    made.frames.set(batch.frames.all())
    return made
