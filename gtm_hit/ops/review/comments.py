"""Remarks on an assignment, pinned to frame and person; the worker answers them and says what is done."""

from __future__ import annotations

from dataclasses import dataclass

from django.contrib.auth.models import User
from django.db.models import Prefetch, QuerySet
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Comment, Frame, Worker
from gtm_hit.ops.review.actors import require_reviewer, require_worker
from gtm_hit.ops.review.refusals import Incomplete, WrongState

MOST_LETTERS = 2000
MOST_COMMENTS = 500  # of one assignment, answers included
LARGEST = 2**31 - 2
State = Assignment.State


@dataclass(frozen=True)
class Pin:
    """Where a remark belongs: a frame's number, there a person, a position, or both; nothing: all of it."""

    frame: int | None = None
    person: int | None = None
    position: int | None = None


def remark(assignment: Assignment, by: User, text: str, pin: Pin) -> Comment:
    """A reviewer's, while the work is with him or with its worker again. Raises ReviewRefused."""
    require_reviewer(assignment, by)
    if assignment.state not in {State.SUBMITTED, State.RETURNED}:
        raise WrongState(_("This batch is decided: nobody would read the comment."))
    frame = pinned_frame(assignment, pin)
    return Comment.objects.create(
        assignment=assignment,
        user=by,
        text=checked_text(assignment, text),
        frame=frame,
        person=pin.person,
        position=pin.position,
    )


def answer(comment: Comment, by: User | Worker, text: str) -> Comment:
    """Everybody's who takes part; answers to answers belong to the first remark. Raises ReviewRefused."""
    require_party(comment.assignment, by)
    if comment.assignment.state not in {State.SUBMITTED, State.RETURNED}:
        raise WrongState(_("This batch is decided: nobody would read the answer."))
    return Comment.objects.create(
        assignment=comment.assignment,
        answers=comment.answers or comment,
        user=by if isinstance(by, User) else None,
        worker=by if isinstance(by, Worker) else None,
        text=checked_text(comment.assignment, text),
    )


def resolve(comment: Comment, by: User | Worker, resolved: bool) -> Comment:
    """Mark a remark as done, or as open again. Raises ReviewRefused."""
    require_party(comment.assignment, by)
    if comment.answers_id is not None:
        raise Incomplete(_("Answers are not done or undone: the remark they answer is."))
    if comment.assignment.state not in {State.SUBMITTED, State.RETURNED}:
        raise WrongState(_("This batch is decided."))
    comment.resolved_at = (comment.resolved_at or timezone.now()) if resolved else None
    comment.save(update_fields=["resolved_at"])
    return comment


def exist(assignment: Assignment) -> bool:
    return Comment.objects.filter(assignment=assignment).exists()


def threads(assignment: Assignment) -> QuerySet[Comment]:
    """The remarks with their answers, by frame, those about everything first; two queries."""
    answers = Comment.objects.select_related("user", "worker").order_by("pk")
    found = Comment.objects.filter(assignment=assignment, answers=None)
    found = found.select_related("user", "worker", "frame").prefetch_related(Prefetch("replies", answers))
    return found.order_by("frame__number", "pk")


def require_party(assignment: Assignment, by: User | Worker) -> None:
    (require_worker if isinstance(by, Worker) else require_reviewer)(assignment, by)


def checked_text(assignment: Assignment, text: str) -> str:
    text = text.replace("\x00", "").strip()
    if not text:
        raise Incomplete(_("The comment is empty."))
    if len(text) > MOST_LETTERS:
        raise Incomplete(_("A comment has at most %(most)d characters.") % {"most": MOST_LETTERS})
    if Comment.objects.filter(assignment=assignment).count() >= MOST_COMMENTS:
        raise Incomplete(_("A batch has at most %(most)d comments.") % {"most": MOST_COMMENTS})
    return text


def pinned_frame(assignment: Assignment, pin: Pin) -> Frame | None:
    if pin.frame is None:
        if pin.person is not None or pin.position is not None:
            raise Incomplete(_("A person or a place is in a frame: say in which."))
        return None
    frame = Frame.objects.filter(batches=assignment.batch_id, number=pin.frame).first()
    if frame is None:
        raise Incomplete(_("The batch has no frame %(number)d.") % {"number": pin.frame})
    grid = assignment.batch.dataset.grid
    if pin.position is not None and not 0 <= pin.position < grid.columns * grid.rows:
        raise Incomplete(_("There is no position %(position)d.") % {"position": pin.position})
    if pin.person is not None and not 0 <= pin.person <= LARGEST:
        raise Incomplete(_("There is no person %(person)d.") % {"person": pin.person})
    return frame
