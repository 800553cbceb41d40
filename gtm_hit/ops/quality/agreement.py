"""How far workers who did the same batch agree; workers go by their pseudonyms."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from django.db.models import Count, Q, QuerySet

from gtm_hit.metrics import agreement
from gtm_hit.metrics.agreement import Agreement, PairAgreement, WorkerBias
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.models import Assignment, Campaign, Dataset
from gtm_hit.ops.quality.layer_rows import read_layers
from gtm_hit.ops.quality.statistics.numbers import plain

FINISHED = [Assignment.State.SUBMITTED, Assignment.State.ACCEPTED]


@dataclass(frozen=True)
class BatchAgreement:
    number: int
    agreement: Agreement  # pairs and workers by pseudonym

    @property
    def overall(self) -> PairAgreement:
        return self.agreement.overall

    @property
    def workers(self) -> dict[str, WorkerBias]:
        return self.agreement.workers


def shared_batches(dataset: Dataset, campaign: Campaign | None = None) -> QuerySet[Any]:
    """Numbers of the batches that two or more workers finished, ascending; each campaign counts its own."""
    return (
        dataset.batches.filter(campaign=campaign)
        .values("number")
        .annotate(opinions=Count("assignments__worker", Q(assignments__state__in=FINISHED), distinct=True))
        .filter(opinions__gte=2)
        .order_by("number")
        .values_list("number", flat=True)
    )


def batch_agreements(
    dataset: Dataset, numbers: Iterable[int], radius: float = RADIUS, campaign: Campaign | None = None
) -> list[BatchAgreement]:
    """Three queries, however many batches. A worker who did two copies counts with the later one."""
    assignments = (
        Assignment.objects.filter(batch__dataset=dataset, batch__campaign=campaign)
        .filter(batch__number__in=list(numbers), state__in=FINISHED)
        .select_related("batch", "worker", "layer")
        .order_by("batch__number", "submitted_at")
    )
    opinions: dict[int, dict[str, Assignment]] = {}
    for assignment in assignments:
        opinions.setdefault(assignment.batch.number, {})[assignment.worker.pseudonym] = assignment
    rows = read_layers([assignment.layer for assignment in assignments])
    grid = dataset.grid
    return [
        BatchAgreement(
            number,
            agreement.evaluate(
                {name: rows[one.layer_id].annotations(grid) for name, one in sorted(together.items())}, radius
            ),
        )
        for number, together in sorted(opinions.items())
        if len(together) >= 2
    ]


def as_numbers(found: BatchAgreement) -> dict[str, Any]:
    """JSON's types only; metres and fractions; what is not defined is null."""
    return {
        "batch": found.number,
        **_pair(found.overall),
        "pairs": [{"workers": list(pair), **_pair(one)} for pair, one in found.agreement.pairs.items()],
        "workers": {
            name: {
                "annotations": bias.annotations,
                "confirmed": bias.confirmed,
                "bias_x": plain(bias.x),
                "bias_y": plain(bias.y),
                "spread_x": plain(bias.spread_x),
                "spread_y": plain(bias.spread_y),
            }
            for name, bias in found.workers.items()
        },
    }


def _pair(found: PairAgreement) -> dict[str, Any]:
    return {
        "matched": found.matched,
        "matched_share": plain(found.matched_share),
        "median_distance": plain(found.median_distance),
        "p95_distance": plain(found.p95_distance),
        "identity_agreement": plain(found.identity_agreement),
    }
