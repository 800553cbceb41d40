"""What the outbox expects of a platform, and the four ways in which a request ends badly.

Adapters are in `crowd`. What matters for money is whether something can have happened, so that is what the
errors tell apart.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from decimal import Decimal
from typing import Protocol

from gtm_hit.ops.errors import OperationError

SHORTEST_REASON = 100  # characters of what a rejected worker is told
CATEGORIES = (
    "TOO_QUICKLY",
    "TOO_SLOWLY",
    "FAILED_INSTRUCTIONS",
    "INCOMP_LONGITUDINAL",
    "FAILED_CHECK",
    "LOW_EFFORT",
    "MALINGERING",
    "NO_CODE",
    "BAD_CODE",
    "NO_DATA",
    "UNSUPP_DEVICE",
    "OTHER",
)


class PlatformError(OperationError):
    """The platform did not do what was asked; the message is for people."""


class NotSent(PlatformError):
    """No connection: nothing can have happened."""


class Refused(PlatformError):
    """The platform said no: nothing happened, and the same again would not help."""

    def __init__(self, status: int, reason: str) -> None:
        super().__init__(reason)
        self.status = status


class TooFast(PlatformError):
    """Nothing happened; the same may be asked again after `seconds`."""

    def __init__(self, seconds: float) -> None:
        super().__init__(f"The platform asks to wait {seconds:.0f} seconds.")
        self.seconds = seconds


class Unanswered(PlatformError):
    """The answer was lost or says nothing: it may have happened or not."""


def require_reason(message: str, category: str) -> None:
    """What Prolific wants to hear with a rejection; raises Refused before anything is sent."""
    if category not in CATEGORIES:
        raise Refused(400, f"Prolific knows no category {category!r}.")
    if len(message) < SHORTEST_REASON:
        told = f"Prolific wants at least {SHORTEST_REASON} characters of reason for a rejection"
        raise Refused(400, f"{told}; these are {len(message)}.")


@dataclass(frozen=True)
class WorkAtPlatform:
    """A submission as the platform tells it; `bonuses` in whole currency units."""

    submission: str
    participant: str
    status: str
    return_requested: bool = False
    bonuses: tuple[Decimal, ...] = ()
    completed_at: datetime | None = None


@dataclass(frozen=True)
class Bonus:
    """`to`: a submission or a participant."""

    to: str
    amount: Decimal


@dataclass(frozen=True)
class StudyDraft:
    """What is asked of a platform when it shall bring workers."""

    title: str
    description: str
    address: str
    places: int
    minutes: int
    reward: Decimal
    completion_code: str


@dataclass(frozen=True)
class Study:
    identifier: str
    state: str
    places: int = 0
    taken: int = 0


class Platform(Protocol):
    def approve(self, submission: str) -> None: ...

    def reject(self, submission: str, message: str, category: str) -> None: ...

    def request_return(self, submission: str, reasons: list[str]) -> None: ...

    def set_up_bonuses(self, study: str, bonuses: list[Bonus]) -> str:
        """A number to pay by; nothing is paid yet, and it may be done again."""
        ...

    def pay_bonuses(self, prepared: str) -> None:
        """Pays again when it is asked again."""
        ...

    def submission(self, submission: str) -> WorkAtPlatform: ...

    def submissions(self, study: str) -> Iterator[WorkAtPlatform]: ...

    def make_secret(self, workspace: str) -> str: ...

    def subscribe(self, workspace: str, event: str, target: str) -> None: ...

    def create_study(self, draft: StudyDraft) -> Study: ...

    def study(self, identifier: str) -> Study: ...

    def change_study(self, identifier: str, action: str) -> Study: ...
