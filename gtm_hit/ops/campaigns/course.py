"""How a campaign goes: frames by state, then and now, and when it will be done. Three queries."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.db.models import Count, Max
from django.utils import timezone

from gtm_hit.models import Assignment, Campaign, Transition

State = Assignment.State
POINTS = 120  # moments of the figure
RECENT = timedelta(days=3)  # what the forecast goes by
LEAST_HOURS = 0.25  # of work before anything is forecast


@dataclass(frozen=True)
class Piece:
    """One assignment, as far as the course is concerned; `end`: when it left its worker's hands.

    `accepted`: when that was decided; the end where nobody wrote it down.
    """

    batch: int
    worker: int
    state: str
    begin: datetime
    end: datetime | None
    frames: int
    accepted: datetime | None = None


@dataclass(frozen=True)
class Moment:
    """Frames of all copies, at one time."""

    at: datetime
    accepted: int  # accepted until then
    submitted: int  # submitted until then and accepted later, or waiting or returned now
    in_work: int


@dataclass(frozen=True)
class Course:
    frames: int  # of all batches; every copy counts, and what neighbours share counts twice
    batches: Counter[str]  # by state; `free`: anybody may take it
    moments: Sequence[Moment]
    done_at: datetime | None  # when the last batch will be submitted, at the pace of late

    @property
    def frames_done(self) -> int:
        return self.moments[-1].accepted + self.moments[-1].submitted if self.moments else 0

    @property
    def share(self) -> float:
        return self.frames_done / self.frames if self.frames else 0.0


def course(campaign: Campaign, now: datetime | None = None) -> Course:
    now = now or timezone.now()
    sizes = dict(campaign.batches.order_by().values_list("pk").annotate(frames=Count("frames")))
    found = pieces(campaign, sizes, now)
    frames = sum(sizes.values())
    states = Counter(piece.state for piece in found if piece.state in Assignment.HOLDING)
    states["free"] = len(sizes) - states.total()
    moments = moments_of(campaign, found, now)
    return Course(frames, states, moments, forecast(campaign, found, frames, now))


def pieces(campaign: Campaign, sizes: dict[int, int], now: datetime) -> list[Piece]:
    rows = Assignment.objects.filter(batch__campaign=campaign).order_by("leased_at")
    decided, found = accepted_at(campaign), []
    for pk, batch, worker, state, begin, expires, submitted in rows.values_list(
        "pk", "batch", "worker", "state", "leased_at", "expires_at", "submitted_at"
    ):
        # A row may say `leased` for a moment longer than it is true.
        over = state == State.EXPIRED or (state == State.LEASED and expires <= now)
        end = submitted or (min(expires, now) if over else None)
        kept = State.EXPIRED.value if over else state
        accepted = max(decided.get(pk, end), end) if end and kept == State.ACCEPTED else None
        found.append(Piece(batch, worker, kept, begin, end, sizes.get(batch, 0), accepted))
    return found


def accepted_at(campaign: Campaign) -> dict[int, datetime]:
    """By assignment, as far as the step to it was written down."""
    steps = Transition.objects.filter(assignment__batch__campaign=campaign, to_state=State.ACCEPTED)
    return dict(steps.order_by().values_list("assignment").annotate(last=Max("at")))


def moments_of(campaign: Campaign, found: Sequence[Piece], now: datetime) -> list[Moment]:
    """Evenly from the opening, or the first batch that was taken, until now or the end."""
    begins = [moment for moment in (campaign.opened_at, *(piece.begin for piece in found)) if moment]
    if not begins:
        return []
    first, last = min(begins), campaign.closed_at or now
    last = max([last, *(piece.accepted for piece in found if piece.accepted)])  # reviews go on after closing
    changes: list[tuple[datetime, int, int, int]] = []
    for piece in found:
        changes.append((piece.begin, 0, 0, piece.frames))
        if piece.end:
            changes.append((piece.end, *ending(piece)))
        if piece.accepted:
            changes.append((piece.accepted, piece.frames, -piece.frames, 0))
    changes.sort()
    return sampled(changes, first, max(first, last))


def ending(piece: Piece) -> tuple[int, int, int]:
    """What becomes of a piece's frames when they leave the worker's hands."""
    stays = piece.state in {State.SUBMITTED, State.RETURNED, State.ACCEPTED}
    return 0, piece.frames if stays else 0, -piece.frames


def sampled(
    changes: Sequence[tuple[datetime, int, int, int]], first: datetime, last: datetime
) -> list[Moment]:
    moments, index, sums = [], 0, [0, 0, 0]
    for point in range(POINTS + 1):
        at = first + (last - first) * point / POINTS
        while index < len(changes) and changes[index][0] <= at:
            sums = [total + change for total, change in zip(sums, changes[index][1:], strict=True)]
            index += 1
        moments.append(Moment(at, *sums))
    return moments


def forecast(campaign: Campaign, found: Sequence[Piece], frames: int, now: datetime) -> datetime | None:
    """At the pace of the last days. None: done, not open, or nothing to go by."""
    if campaign.state != Campaign.State.OPEN or campaign.opened_at is None:
        return None
    done = [piece for piece in found if piece.state in Assignment.HOLDING and piece.state != State.LEASED]
    left = frames - sum(piece.frames for piece in done)
    since = max(now - RECENT, campaign.opened_at)
    hours = (now - since).total_seconds() / 3600
    recent = sum(piece.frames for piece in done if piece.end and piece.end >= since)
    if left <= 0 or not recent or hours < LEAST_HOURS:
        return None
    return now + timedelta(hours=left / (recent / hours))
