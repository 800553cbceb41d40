"""Why a transition, a comment or an answer is refused; the code is for programs, the message for people."""

from __future__ import annotations

from gtm_hit.ops.errors import OperationError


class ReviewRefused(OperationError):
    code = "invalid"


class WrongState(ReviewRefused):
    """The assignment is not where this step begins; somebody else may have been faster."""

    code = "wrong_state"


class NotAllowed(ReviewRefused):
    """This step is somebody else's."""

    code = "forbidden"


class OwnWork(NotAllowed):
    """Nobody reviews his own work, and nobody decides an appeal against himself."""

    code = "own_work"


class Incomplete(ReviewRefused):
    """A reason, a category or a comment is missing."""

    code = "invalid"
