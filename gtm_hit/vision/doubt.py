"""How much a proposal should be looked at: the doubtful come first."""

from __future__ import annotations

from collections.abc import Sequence

from gtm_hit.vision.people import Evidence

SEEN = 0.5  # share of a rectangle that is not background, from which on a view agrees


def agreement(evidence: Sequence[Evidence]) -> float:
    """Share of the views that could see the person and do; 1 where no view could, or none says."""
    open_views = [each for each in evidence if not each.hidden and (each.box or each.seen == each.seen)]
    if not open_views:
        return 1.0
    return sum(each.box is not None or each.seen >= SEEN for each in open_views) / len(open_views)


def doubt(score: float, evidence: Sequence[Evidence], certainty: float) -> float:
    """0 to 1: by the score, by views that disagree, by tracks that could have gone on otherwise."""
    return 1.0 - score * (0.5 + 0.5 * agreement(evidence)) * (0.5 + 0.5 * certainty)
