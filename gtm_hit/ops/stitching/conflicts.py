"""What nobody but a person can decide: asked once, remembered, and taken back on request."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Sequence

import numpy as np
from django.contrib.auth.models import User
from django.db import transaction
from django.utils import timezone

from gtm_hit.models import StitchConflict, Stitching
from gtm_hit.ops.stitching.scope import StitchingError
from gtm_hit.stitching.stitching import Stitched
from gtm_hit.stitching.tracks import Source, Track
from gtm_hit.stitching.verdicts import Verdict

State, Decision, Kind = StitchConflict.State, StitchConflict.Decision, StitchConflict.Kind
WRITTEN_AT_ONCE = 500


def verdicts(stitching: Stitching) -> list[Verdict]:
    """What was decided, the latest last."""
    decided = StitchConflict.objects.filter(stitching=stitching, state=State.DECIDED)
    decided = decided.order_by("decided_at", "pk")
    return [
        Verdict(_sources(before), _sources(after), decision == Decision.SAME)
        for before, after, decision in decided.values_list("before", "after", "decision")
    ]


def ask(stitching: Stitching, stitched: Stitched, numbers: Sequence[int]) -> None:
    """Make the open questions those of this run; what was decided stays, asked again or not.

    numbers : frame numbers by instant
    """
    asked = {}
    for doubt in stitched.doubts:
        row = _row(stitching, Kind.JOIN, doubt.before, doubt.after, numbers)
        row.seconds, row.lead = doubt.seconds, doubt.lead
        asked[row.key] = row
    for back in stitched.returns:
        row = _row(stitching, Kind.RETURN, back.before, back.after, numbers)
        row.seconds, row.metres = back.seconds, back.metres
        asked.setdefault(row.key, row)
    with transaction.atomic():
        mine = StitchConflict.objects.filter(stitching=stitching)
        known = dict(mine.values_list("key", "state"))
        stale = [key for key, state in known.items() if state == State.OPEN and key not in asked]
        for start in range(0, len(stale), WRITTEN_AT_ONCE):
            mine.filter(key__in=stale[start : start + WRITTEN_AT_ONCE]).delete()
        _write(row for key, row in asked.items() if known.get(key) != State.DECIDED)


def decide(conflict: StitchConflict, decision: str, user: User | None) -> StitchConflict:
    """Raises StitchingError where somebody else has decided otherwise meanwhile."""
    if decision not in Decision.values:
        raise StitchingError(f"{decision} is no decision.")
    with transaction.atomic():
        row = StitchConflict.objects.select_for_update().get(pk=conflict.pk)
        if row.state == State.DECIDED:
            if row.decision != decision:
                said = f"{_name(row)} has decided: {row.get_decision_display()}."
                raise StitchingError(f"{said} Undo that first.")
            return row
        row.state, row.decision = State.DECIDED, decision
        row.decided_by, row.decided_at = user, timezone.now()
        row.save(update_fields=["state", "decision", "decided_by", "decided_at"])
    return row


def undo(conflict: StitchConflict) -> StitchConflict:
    """Open again; the next run goes by what it sees."""
    with transaction.atomic():
        row = StitchConflict.objects.select_for_update().get(pk=conflict.pk)
        if row.state == State.OPEN:
            raise StitchingError("Nothing has been decided here.")
        row.state, row.decision, row.decided_by, row.decided_at = State.OPEN, "", None, None
        row.save(update_fields=["state", "decision", "decided_by", "decided_at"])
    return row


def _row(
    stitching: Stitching, kind: str, before: Track, after: Track, numbers: Sequence[int]
) -> StitchConflict:
    sides = [sorted(before.sources), sorted(after.sources)]
    return StitchConflict(
        stitching=stitching,
        kind=kind,
        key=hashlib.sha256(json.dumps(sides).encode()).hexdigest(),
        before=sides[0],
        after=sides[1],
        left_at=numbers[before.last],
        came_at=numbers[after.first],
        metres=float(np.hypot(*(after.xy[0] - before.xy[-1]))),
        seconds=0.0,
    )


def _write(rows: Iterable[StitchConflict]) -> None:
    StitchConflict.objects.bulk_create(
        rows,
        batch_size=WRITTEN_AT_ONCE,
        update_conflicts=True,
        unique_fields=["stitching", "key"],
        update_fields=["kind", "left_at", "came_at", "metres", "seconds", "lead"],
    )


def _sources(kept: Iterable[Sequence[int]]) -> frozenset[Source]:
    return frozenset((layer, person) for layer, person in kept)


def _name(row: StitchConflict) -> str:
    return row.decided_by.get_username() if row.decided_by else "Somebody"
