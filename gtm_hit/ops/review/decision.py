"""What a worker is told about the decision on his work. Nobody of the staff is named."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from gtm_hit.models import Appeal, Assignment, Category
from gtm_hit.ops.review.queue import last_step


@dataclass(frozen=True)
class Decision:
    state: str
    category: str  # in words; empty unless rejected
    reason: str
    may_appeal: bool
    appeal: dict[str, str] | None  # text, outcome, answer

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def told(assignment: Assignment) -> Decision:
    state = Assignment.objects.values_list("state", flat=True).get(pk=assignment.pk)
    rejected = state == Assignment.State.REJECTED
    step = last_step(assignment, "reject") if rejected else last_step(assignment, "accept", "return")
    appeal = Appeal.objects.filter(assignment=assignment).first()
    return Decision(
        state=state,
        category=str(Category(step.category).label) if step and step.category else "",
        reason=step.reason if step else "",
        may_appeal=rejected and appeal is None,
        appeal={"text": appeal.text, "outcome": appeal.outcome, "answer": appeal.answer} if appeal else None,
    )
