"""What an assignment's state allows its worker now, and what of the work is left."""

from __future__ import annotations

from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Frame
from gtm_hit.ops.errors import OperationError

State = Assignment.State


class AssignmentError(OperationError):
    pass


class ReadOnly(AssignmentError):
    """The layer may not be changed now; `reason` is `submitted`, `expired`, `not_author` or `protected`."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class Unfinished(AssignmentError):
    """Frames of the batch that are not done on the server's record."""

    def __init__(self, frames: list[int]) -> None:
        super().__init__(f"frames not done: {frames}")
        self.frames = frames


def read_only_reason(assignment: Assignment) -> str:
    """Why the assignment's layer may not be changed now; empty when it may."""
    if assignment.editable:
        return ""
    return "expired" if assignment.state in {State.LEASED, State.EXPIRED} else "submitted"


def explained(reason: str) -> str:
    """A `read_only_reason` in plain words; empty for empty."""
    texts = {
        "submitted": _("This batch is submitted; it can be looked at, not changed."),
        "expired": _("The time for this batch has run out. Open your start page to continue with it."),
        "protected": _(
            "Imported, hidden and released layers are changed by managers and maintainers, at the browser."
        ),
        "not_author": _("A worker's annotations are changed by that worker only."),
    }
    return texts.get(reason, reason)


def done_frames(assignment: Assignment) -> list[int]:
    """Numbers of the batch's frames that are done on the server's record."""
    done = Frame.objects.filter(
        batches=assignment.batch_id, layer_frames__layer=assignment.layer_id, layer_frames__done=True
    )
    return list(done.order_by("number").values_list("number", flat=True))


def unfinished_frames(assignment: Assignment) -> list[int]:
    frames = Frame.objects.filter(batches=assignment.batch_id).exclude(number__in=done_frames(assignment))
    return list(frames.order_by("number").values_list("number", flat=True))
