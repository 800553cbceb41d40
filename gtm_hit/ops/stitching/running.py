"""Stitching as a job: read → stitch → write what differs → ask what is not clear."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from django.contrib.auth.models import User
from django.db import transaction

from gtm_hit.models import Campaign, Dataset, Frame, Job, Stitching, StitchingRun
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import Progress, percents
from gtm_hit.ops.review.mending import layer_that_counts
from gtm_hit.ops.stitching import conflicts, numbering
from gtm_hit.ops.stitching.reading import READING, Accepted, read
from gtm_hit.ops.stitching.scope import Scope, StitchingError, opened
from gtm_hit.ops.stitching.writing import WRITING_LAYER, Wanted, Written, write
from gtm_hit.stitching.rules import Rules, RulesError
from gtm_hit.stitching.stitching import Stitched, stitch
from gtm_hit.stitching.tracks import Track

STITCHING = "fusing and joining"
SHARES = {READING: (0, 20), STITCHING: (20, 70), WRITING_LAYER: (70, 100)}
SETTABLE = ("gate", "gap", "margin", "return_seconds", "return_reach")
WORKERS_LISTED = 200


@dataclass(frozen=True)
class Asked:
    """What may be chosen; the rest of the rules is the dataset's."""

    gate: float = Rules.gate
    gap: int = Rules.gap
    margin: float = Rules.margin
    return_seconds: float = Rules.return_seconds
    return_reach: float = Rules.return_reach

    def rules(self, dataset: Dataset) -> Rules:
        """Raises StitchingError."""
        try:
            return Rules(**asdict(self), seconds=dataset.seconds_per_frame)
        except RulesError as error:
            raise StitchingError(str(error)) from error


def start(scope: Scope, asked: Asked, user: User | None = None) -> Job:
    """Queue it; the same one under way when there is one. StitchingError for what cannot be stitched."""
    asked.rules(scope.dataset)
    _require_work(scope)
    parameters = {
        "campaign_id": scope.campaign.pk if scope.campaign else None,
        "campaign": scope.campaign.name if scope.campaign else "",
        **asdict(asked),
    }
    return queue.create_once(Job.Kind.STITCH, scope.dataset, parameters, user)


def run(mine: queue.Run) -> dict[str, Any]:
    """The operation of the job; a worker that takes it up again finds most frames written already."""
    parameters, dataset = mine.job.parameters, mine.job.dataset
    if dataset is None:
        raise StitchingError("The dataset is no longer there.")
    campaign = None
    if parameters["campaign_id"] is not None:
        campaign = Campaign.objects.filter(pk=parameters["campaign_id"]).first()
        if campaign is None:
            raise StitchingError("The campaign is no longer there.")
    asked = Asked(**{name: parameters[name] for name in SETTABLE})
    made = stitch_layer(Scope(dataset, campaign), asked, mine.job.created_by, percents(mine, SHARES), mine)
    return made.numbers


def stitch_layer(
    scope: Scope, asked: Asked, user: User | None, report: Progress, mine: queue.Run | None = None
) -> StitchingRun:
    """Bring the ground-truth layer up to date."""
    rules = asked.rules(scope.dataset)
    _require_work(scope)
    stitching = opened(scope)
    accepted = read(scope, report)
    verdicts = conflicts.verdicts(stitching)
    stitched = stitch(accepted.groups, rules, verdicts, lambda done, total: report(STITCHING, done, total))
    persons = numbering.numbers(stitching.layer, stitched.people, accepted.frames)
    written = write(stitching.layer, _wanted(scope, accepted, stitched, persons), user, report)
    numbers = dict(Frame.objects.filter(dataset=scope.dataset).values_list("pk", "number"))
    found = _numbers(accepted, stitched, written, numbers)
    with transaction.atomic():
        conflicts.ask(stitching, stitched, [numbers[pk] for pk in accepted.frames])
        if mine is not None:
            mine.keep(message="")
        return _keep(stitching, mine, asked, found, user)


def _require_work(scope: Scope) -> None:
    if scope.stitching() is None and not scope.accepted().exists():
        raise StitchingError("No batch has been accepted yet: there is nothing to stitch.")


def _wanted(
    scope: Scope, accepted: Accepted, stitched: Stitched, persons: Sequence[int]
) -> dict[int, Wanted]:
    """By frame id, also covered frames with nobody."""
    covered = {instant for group in accepted.groups for batch in group for instant in batch.frames.tolist()}
    wanted: dict[int, Wanted] = {accepted.frames[instant]: [] for instant in sorted(covered)}
    for person, track in zip(persons, stitched.people, strict=True):
        for instant, position, votes in zip(
            track.frames.tolist(), _positions(scope, track), track.votes, strict=True
        ):
            wanted[accepted.frames[instant]].append((person, position, votes))
    return wanted


def _positions(scope: Scope, track: Track) -> list[int]:
    """Of the grid; smoothing can put somebody at its border half a step beyond."""
    grid = scope.dataset.grid
    first, last = grid.metres([0])[0], grid.metres([grid.count - 1])[0]
    nearest: list[int] = grid.nearest(track.xy.clip(first, last)).tolist()
    return nearest


def _numbers(
    accepted: Accepted, stitched: Stitched, written: Written, numbers: Mapping[int, int]
) -> dict[str, Any]:
    """What the page shows of a run."""
    return {
        "batches": len(accepted.groups),
        "assignments": len(accepted.assignments),
        "people": len(stitched.people),
        "annotations": sum(len(track.frames) for track in stitched.people),
        "joins": stitched.joins,
        "doubts": len(stitched.doubts),
        "returns": len(stitched.returns),
        "frames_changed": written.changed,
        "frames_same": written.same,
        "frames_emptied": written.emptied,
        "frames_by_hand": [numbers[pk] for pk in written.by_hand],
        "workers": _workers(accepted, stitched),
    }


def _workers(accepted: Accepted, stitched: Stitched) -> list[dict[str, Any]]:
    """How far workers of batches with several copies are from what all of them together say."""
    worker_of = {layer_that_counts(one): one.worker.pseudonym for one in accepted.assignments}
    sums: dict[str, dict[str, Any]] = {}
    for layers, found in zip(accepted.layers, stitched.disagreements, strict=True):
        if len(layers) < 2:
            continue
        for layer, each in zip(layers, found, strict=True):
            name = worker_of[layer]
            mine = sums.setdefault(name, {"worker": name, "batches": 0, **dict.fromkeys(asdict(each), 0)})
            mine["batches"] += 1
            for key, value in asdict(each).items():
                mine[key] += value
    for mine in sums.values():
        mine["distance"] = round(mine["distance"] / mine["places"], 4) if mine["places"] else None
    farthest = sorted(sums.values(), key=lambda each: (-(each["distance"] or 0), each["worker"]))
    return farthest[:WORKERS_LISTED]


def _keep(
    stitching: Stitching, mine: queue.Run | None, asked: Asked, numbers: dict[str, Any], user: User | None
) -> StitchingRun:
    values = {"stitching": stitching, "rules": asdict(asked), "numbers": numbers, "created_by": user}
    if mine is None:
        return StitchingRun.objects.create(**values)
    return StitchingRun.objects.update_or_create(job=mine.job, defaults=values)[0]
