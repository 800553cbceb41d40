"""What every platform answers: who comes in, and how somebody leaves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol

from gtm_hit.ops.errors import OperationError


class ArrivalError(OperationError, ValueError):
    """The address lacks what the platform puts into it; says what to do."""


@dataclass(frozen=True)
class Arrival:
    """Whoever opens the entry address, as the platform names him; empty where it names nobody."""

    external_id: str = ""
    submission: str = ""
    submit_to: str = ""
    preview: bool = False


class Outcome(StrEnum):
    """How it ended for the worker."""

    COMPLETED = "completed"
    NO_WORK = "no_work"
    NOT_ADMITTED = "not_admitted"


@dataclass(frozen=True)
class Stay:
    """Nothing to carry anywhere: the platform is this server."""


@dataclass(frozen=True)
class ShowCode:
    """To be copied to the platform; `address` leads back to it, where it is known."""

    code: str
    address: str = ""


@dataclass(frozen=True)
class Redirect:
    address: str


@dataclass(frozen=True)
class FormPost:
    action: str
    fields: dict[str, str] = field(default_factory=dict)


Exit = Stay | ShowCode | Redirect | FormPost


@dataclass(frozen=True)
class Framing:
    """Origins whose pages may show ours, and that take our forms."""

    ancestors: tuple[str, ...]
    forms: tuple[str, ...]


class Platform(Protocol):
    """One per platform, made from a campaign's settings."""

    # A seat belongs to a piece of the platform's work, whose id nobody else knows; otherwise to the browser
    # it was taken in, or to an account.
    by_submission: bool
    by_login: bool

    def arrival(self, given: Mapping[str, str]) -> Arrival:
        """From the entry address or its form. Raises ArrivalError."""

    def leave(self, outcome: Outcome, code: str, arrival: Arrival) -> Exit:
        """`code`: the batch's own completion code; empty where no batch was done."""

    def entry_address(self, link: str) -> str:
        """What is pasted into the platform, with its placeholders."""

    def framing(self) -> Framing | None:
        """Who may embed the pages; None: nobody."""
