"""Which assignments somebody should look at first, and why."""

from __future__ import annotations

from django.db.models import F, QuerySet

from gtm_hit.models import Assignment, AssignmentScore, Campaign
from gtm_hit.ops.scores.computing import evidence_of, submitted
from gtm_hit.ops.scores.measuring import measure
from gtm_hit.scoring.suspicion import Signal, Suspicion, usual
from gtm_hit.scoring.suspicion import suspicion as judged


def suspicion(assignment: Assignment) -> Suspicion:
    """`value` from 0 to 1 and the signals behind it: as computed last, else counted now. Writes nothing."""
    row = AssignmentScore.objects.filter(assignment=assignment).first()
    if row is not None:
        return Suspicion(row.suspicion, [Signal(**reason) for reason in row.reasons])
    campaign = assignment.batch.campaign
    known = evidence_of(campaign).values() if campaign else []
    return judged(measure(assignment), usual(known))


def by_suspicion(campaign: Campaign) -> QuerySet[Assignment]:
    """Submitted work with its `score` at hand, most suspicious first; what nobody measured yet comes last."""
    found = submitted(campaign).select_related("score")
    return found.order_by(F("score__suspicion").desc(nulls_last=True), "submitted_at", "pk")
