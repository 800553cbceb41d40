"""What is told of reviews, by REST and commands alike. Workers go by their pseudonyms."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gtm_hit.models import Appeal, Assignment, Comment, Mend, ReviewChoice, Transition
from gtm_hit.ops.review import comments, queue


def assignment_part(assignment: Any) -> dict[str, Any]:
    """Of a row of `queue.described`."""
    choice: ReviewChoice | None = getattr(assignment, "review_choice", None)
    campaign = assignment.batch.campaign
    return {
        "id": assignment.pk,
        "batch": assignment.batch.number,
        "copy": assignment.batch.copy,
        "campaign": campaign.name if campaign else None,
        "worker": assignment.worker.pseudonym,
        "layer": assignment.layer.name,
        "state": assignment.state,
        "submitted_at": assignment.submitted_at.isoformat() if assignment.submitted_at else None,
        "frames": assignment.frame_count,
        "people": assignment.people,
        "open_comments": assignment.open_comments,
        "why": choice.why if choice else None,
        "suspicion": choice.suspicion if choice else None,
        "reasons": choice.reasons if choice else [],
    }


def transition_part(step: Transition) -> dict[str, Any]:
    worker = step.worker.pseudonym if step.worker else ""
    return {
        "number": step.number,
        "action": step.action,
        "from": step.from_state,
        "to": step.to_state,
        "by": step.user.get_username() if step.user else worker or "system",
        "category": step.category,
        "reason": step.reason,
        "at": step.at.isoformat(),
    }


def decided_part(step: Transition) -> dict[str, Any]:
    return {
        "id": step.assignment_id,
        "batch": step.assignment.batch.number,
        "copy": step.assignment.batch.copy,
        "worker": step.assignment.worker.pseudonym,
        **transition_part(step),
    }


def appeal_part(appeal: Appeal) -> dict[str, Any]:
    return {
        "id": appeal.assignment_id,
        "text": appeal.text,
        "outcome": appeal.outcome,
        "answer": appeal.answer,
        "created_at": appeal.created_at.isoformat(),
        "decided_at": appeal.decided_at.isoformat() if appeal.decided_at else None,
    }


def comment_part(comment: Comment) -> dict[str, Any]:
    """Workers are not told which of the staff wrote."""
    return {
        "id": comment.pk,
        "frame": comment.frame.number if comment.frame else None,
        "person": comment.person,
        "position": comment.position,
        "text": comment.text,
        "role": "reviewer" if comment.user_id else "worker",
        "at": comment.created_at.isoformat(),
        "resolved": comment.resolved_at is not None,
    }


def comments_of(assignment: Assignment) -> list[dict[str, Any]]:
    return [
        {**comment_part(one), "answers": [comment_part(answer) for answer in one.replies.all()]}
        for one in comments.threads(assignment)
    ]


def whole(assignment: Any) -> dict[str, Any]:
    """An assignment with everything that was said and done about it."""
    steps = assignment.transitions.select_related("user", "worker").order_by("number")
    appeal = Appeal.objects.filter(assignment=assignment).first()
    mend = Mend.objects.select_related("layer", "user").filter(assignment=assignment).first()
    return {
        **assignment_part(assignment),
        "comments": comments_of(assignment),
        "steps": [transition_part(step) for step in steps],
        "appeal": appeal_part(appeal) if appeal else None,
        "mended": {"layer": mend.layer.name, "by": mend.user.get_username()} if mend else None,
    }


LISTS: dict[str, tuple[Callable[[queue.Scope], Any], Callable[[Any], dict[str, Any]]]] = {
    "waiting": (queue.waiting, assignment_part),
    "returned": (queue.returned, assignment_part),
    "decided": (queue.decided, decided_part),
    "appeals": (queue.open_appeals, appeal_part),
}
