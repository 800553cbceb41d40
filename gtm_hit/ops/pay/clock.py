"""Active seconds as the server can believe them.

Browsers measure, with a cut at idleness; the server keeps, for every assignment, the real time that nobody
has counted yet, and a save counts from it and no more. So all seconds of an assignment together never exceed
the real time it took, however many tabs tell of the same minute. Saves that come together (a train of frames
after a time without network) share what passed before them. Between such trains only `KEPT` seconds wait for
a frame that was looked at and not saved yet: a pause is no store of time to count twice from.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from django.conf import settings

from gtm_hit.models import Assignment, WorkClock

TOGETHER = timedelta(seconds=10)
KEPT = 120.0  # seconds


@dataclass(frozen=True)
class Clock:
    seen_at: datetime
    burst_at: datetime
    spare: float = 0.0


def count(clock: Clock, now: datetime, told: float, longest: float) -> tuple[Clock, float]:
    """The clock after a save that tells of so many seconds, and how many of them count.

    `longest`: seconds after which nobody can still have been at work without a save.
    """
    spare, burst_at = clock.spare, clock.burst_at
    if now - burst_at > TOGETHER:
        spare, burst_at = min(spare, KEPT), now
    passed = max((now - clock.seen_at).total_seconds(), 0.0)
    spare += min(passed, longest)
    counted = min(told, spare)
    return replace(clock, seen_at=max(now, clock.seen_at), burst_at=burst_at, spare=spare - counted), counted


def believed(assignment: Assignment, told: float, now: datetime) -> float:
    """Count a save's seconds; the assignment's row is locked by the caller."""
    row = WorkClock.objects.filter(assignment=assignment).first() or begun(assignment)
    before = Clock(row.seen_at, row.burst_at, row.spare)
    after, counted = count(before, now, told, settings.LEASE_MINUTES * 60.0)
    row.seen_at, row.burst_at, row.spare = after.seen_at, after.burst_at, after.spare
    row.counted += counted
    row.told += told
    row.save()
    return counted


def begun(assignment: Assignment) -> WorkClock:
    return WorkClock(assignment=assignment, seen_at=assignment.leased_at, burst_at=assignment.leased_at)
