"""How operations say how far they are: the one `Progress` of commands, jobs and everything they call.

Where an operation has one phase only it takes `Steps`; `partial(progress, PHASE)` makes them of a `Progress`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from gtm_hit.geometry.steps import Steps
from gtm_hit.ops.jobs import queue

__all__ = ["UNPACKING", "WRITING", "Progress", "Shares", "Steps", "no_progress", "percents", "steps"]

UNPACKING = "unpacking"
WRITING = "writing to the database"

Shares = Mapping[str, tuple[int, int]]
"""Percents of the whole at which each phase begins and ends."""


class Progress(Protocol):
    """Told the phase in words, steps done and steps in all; what it raises stops the operation."""

    def __call__(self, phase: str, done: int, total: int, /) -> object: ...


def no_progress(_phase: str, _done: int, _total: int, /) -> None:
    pass


def percents(mine: queue.Run, shares: Shares) -> Progress:
    """Tells the job's row phases as percents of the whole.

    Of WRITING only the beginning, which is confirmed. From there on Cancel takes nothing back, and a report
    out of the transaction would be seen by nobody and lock the row.
    """

    def progress(phase: str, done: int, total: int, /) -> None:
        first, last = shares[phase]
        at = first + (last - first) * done // max(total, 1)
        if phase != WRITING:
            mine.report(at, 100, _words(phase, done, total))
        elif done == 0:
            mine.confirm(at, 100, _words(phase, done, total))

    return progress


def steps(mine: queue.Run) -> Progress:
    """Tells the job's row the steps themselves: for operations whose phases count the same things."""

    def progress(phase: str, done: int, total: int, /) -> None:
        mine.report(done, total, _words(phase, done, total))

    return progress


def _words(phase: str, done: int, total: int) -> str:
    return f"{phase}: {done} of {total}"
