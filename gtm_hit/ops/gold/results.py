"""How gold frames and planted faults came out in a campaign."""

from __future__ import annotations

from dataclasses import dataclass

from django.db.models import Count, Q

from gtm_hit.models import Campaign, GoldFrame, PlantedFault
from gtm_hit.ops.scores.computing import evidence_of, total


@dataclass(frozen=True)
class KindResult:
    kind: str
    label: str
    planted: int
    judged: int
    repaired: int

    @property
    def share(self) -> float | None:
        return self.repaired / self.judged if self.judged else None


@dataclass(frozen=True)
class GoldResult:
    frames: int  # gold frames of the campaign
    judged: int  # times somebody did one
    truth: int  # people in those
    found: float
    extra: float
    placed: float  # of those found, near enough


def fault_results(campaign: Campaign) -> list[KindResult]:
    """One line per kind, also of kinds that were never planted; one query."""
    rows = PlantedFault.objects.filter(assignment__batch__campaign=campaign).order_by().values_list("kind")
    counted = {
        kind: (planted, judged, repaired)
        for kind, planted, judged, repaired in rows.annotate(
            planted=Count("pk"),
            judged=Count("pk", filter=Q(repaired__isnull=False)),
            mended=Count("pk", filter=Q(repaired=True)),
        )
    }
    return [
        KindResult(kind, str(label), *counted.get(kind, (0, 0, 0)))
        for kind, label in PlantedFault.Kind.choices
    ]


def gold_result(campaign: Campaign) -> GoldResult:
    evidence = total(evidence_of(campaign).values())
    return GoldResult(
        frames=GoldFrame.objects.filter(campaign=campaign).count(),
        judged=round(evidence.gold_frames),
        truth=round(evidence.truth),
        found=evidence.matched,
        extra=evidence.found - evidence.matched,
        placed=evidence.placed,
    )
