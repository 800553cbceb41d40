"""A step that was taken, as its consequences are told of it."""

from __future__ import annotations

from dataclasses import dataclass

from gtm_hit.models import Assignment, Transition
from gtm_hit.ops.review.actors import Actor
from gtm_hit.ops.review.machine import Action


@dataclass(frozen=True)
class Happened:
    """The assignment is locked and in its new state; category and reason stand in the transition."""

    assignment: Assignment
    transition: Transition
    action: Action
    by: Actor


@dataclass(frozen=True)
class Following:
    """A step the system takes next."""

    action: Action
    reason: str = ""
