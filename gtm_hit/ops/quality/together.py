"""A worker beside others who did the same frames: how far they agree, and which way the worker leans."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from django.db.models import Count, Q

from gtm_hit.metrics.agreement import PairAgreement, WorkerBias
from gtm_hit.models import Assignment, Batch, Campaign, Worker
from gtm_hit.ops.quality.agreement import FINISHED, batch_agreements

MOST_BATCHES = 10  # the latest; each is compared while the page waits


@dataclass(frozen=True)
class Together:
    """Centimetres; `x` and `y` are the mean of the worker's places minus the others'."""

    batches: int
    agreement: float  # share of the annotations of both sides that the other has too
    x: float
    y: float
    confirmed: int  # annotations they are the mean of

    @property
    def percent(self) -> int:
        return round(100 * self.agreement)

    @property
    def x_shown(self) -> str:
        return signed(self.x)

    @property
    def y_shown(self) -> str:
        return signed(self.y)


def signed(centimetres: float) -> str:
    """To a millimetre; what is nothing then has no sign."""
    told = f"{centimetres:+.1f}"
    return "0.0" if told in {"+0.0", "-0.0"} else told


def of_worker(campaign: Campaign, worker: Worker) -> Together | None:
    """None where nobody else finished the same frames. Four queries, however many batches."""
    numbers = shared_by(campaign, worker)
    found = batch_agreements(campaign.dataset, numbers, campaign=campaign)
    name = worker.pseudonym
    mine = [one for one in found if name in one.workers]
    pairs = [pair for one in mine for names, pair in one.agreement.pairs.items() if name in names]
    return pooled(len(mine), pairs, [one.workers[name] for one in mine])


def shared_by(campaign: Campaign, worker: Worker) -> list[int]:
    own = Assignment.objects.filter(batch__campaign=campaign, worker=worker, state__in=FINISHED)
    rows = Batch.objects.filter(campaign=campaign, number__in=own.values("batch__number")).order_by()
    opinions = Count("assignments__worker", Q(assignments__state__in=FINISHED), distinct=True)
    shared = rows.values("number").annotate(opinions=opinions).filter(opinions__gte=2)
    return list(shared.order_by("-number").values_list("number", flat=True)[:MOST_BATCHES])


def pooled(batches: int, pairs: Sequence[PairAgreement], biases: Sequence[WorkerBias]) -> Together | None:
    annotations = sum(pair.annotations for pair in pairs)
    if not annotations:
        return None
    told = [one for one in biases if one.confirmed]
    confirmed = sum(one.confirmed for one in told)
    x, y = (
        np.average([(one.x, one.y) for one in told], axis=0, weights=[one.confirmed for one in told])
        if told
        else (np.nan, np.nan)
    )
    agreement = 2 * sum(pair.matched for pair in pairs) / annotations
    return Together(batches, agreement, 100 * float(x), 100 * float(y), confirmed)
