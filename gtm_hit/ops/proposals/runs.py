"""Runs of proposing: what tells them apart, and which one annotators see."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import Avg, Count, F, Q, QuerySet, Sum
from django.utils.translation import gettext as _

from gtm_hit.formats.calibration.cameras_json import cameras_content, content_digest
from gtm_hit.models import Dataset, Proposal, ProposalRun
from gtm_hit.ops.proposals import foregrounds
from gtm_hit.ops.proposals.errors import ProposalError

CALIBRATION = "calibration"


@dataclass(frozen=True)
class RunSummary:
    """A run and what it has so far."""

    run: ProposalRun
    frames: int
    people: int
    tracks: int
    seconds: float | None  # a frame, on average
    alarms: dict[str, int]  # frames in which a camera disagreed with all others
    fits: bool  # it was made with the calibration in place


def calibration_digest(dataset: Dataset) -> str:
    return content_digest(cameras_content(dataset.calibrated_cameras()))


def find_or_make(
    dataset: Dataset, method: str, model: str, parameters: Mapping[str, Any], user: User | None = None
) -> ProposalRun:
    """The dataset's run with exactly these values and the calibration in place."""
    if method not in ProposalRun.Method.values:
        raise ProposalError(_("There is no method %(name)s.") % {"name": method})
    told = {**parameters, CALIBRATION: calibration_digest(dataset)}
    values = {"method": method, "model": model, "parameters": told, "created_by": user}
    run, _made = ProposalRun.objects.get_or_create(
        dataset=dataset, digest=_digest(dataset, method, model, told), defaults=values
    )
    return run


def _digest(dataset: Dataset, method: str, model: str, parameters: Mapping[str, Any]) -> str:
    grid, cylinder = dataset.grid, dataset.cylinder
    told = [method, model, dict(parameters), vars(grid), vars(cylinder), dataset.foot_rule]
    return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()


def use(run: ProposalRun) -> None:
    """Show annotators the people of this run, and of no other."""
    with transaction.atomic():
        Dataset.objects.select_for_update(no_key=True).get(pk=run.dataset_id)
        ProposalRun.objects.filter(dataset=run.dataset_id, in_use=True).update(in_use=False)
        ProposalRun.objects.filter(pk=run.pk).update(in_use=True)
    run.in_use = True


def use_none(dataset: Dataset) -> None:
    ProposalRun.objects.filter(dataset=dataset, in_use=True).update(in_use=False)


def in_use(dataset: Dataset) -> ProposalRun | None:
    """The one that annotators see; none whose places another calibration has made wrong."""
    run = ProposalRun.objects.filter(dataset=dataset, in_use=True).first()
    return run if run and fits(run, calibration_digest(dataset)) else None


def fits(run: ProposalRun, calibration: str) -> bool:
    return run.parameters.get(CALIBRATION) == calibration


def runs(dataset: Dataset) -> QuerySet[ProposalRun]:
    return ProposalRun.objects.filter(dataset=dataset).select_related("created_by", "dataset")


def run_of(dataset: Dataset, pk: int) -> ProposalRun | None:
    return runs(dataset).filter(pk=pk).first()


def summaries(dataset: Dataset) -> list[RunSummary]:
    """The newest first."""
    found = list(
        runs(dataset).annotate(
            looked=Count("frames"), average=Avg("frames__seconds", filter=Q(frames__seconds__gt=0))
        )
    )
    people = Proposal.objects.filter(proposal_frame__run__in=found).order_by()
    counted = people.values(run=F("proposal_frame__run")).annotate(
        people=Count("pk"), tracks=Count("track", distinct=True)
    )
    by_run = {row["run"]: row for row in counted}
    calibration = calibration_digest(dataset)
    none = {"people": 0, "tracks": 0}
    return [
        RunSummary(
            run,
            run.looked,
            by_run.get(run.pk, none)["people"],
            by_run.get(run.pk, none)["tracks"],
            run.average,
            alarms(run),
            fits(run, calibration),
        )
        for run in found
    ]


def alarms(run: ProposalRun) -> dict[str, int]:
    """Frames in which each camera disagreed with all others."""
    counts: dict[str, int] = {}
    for suspicious in run.frames.exclude(suspicious=[]).values_list("suspicious", flat=True):
        for alarm in suspicious:
            counts[alarm["camera"]] = counts.get(alarm["camera"], 0) + 1
    return counts


def seconds_of(run: ProposalRun) -> float:
    return run.frames.aggregate(total=Sum("seconds"))["total"] or 0.0


def remove(run: ProposalRun) -> None:
    """With everybody it proposed; annotations that came of it stay."""
    pk = run.pk
    run.delete()
    transaction.on_commit(lambda: foregrounds.remove(pk))
