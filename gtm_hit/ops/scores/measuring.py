"""What can be counted in one submitted assignment."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.metrics.matching import match
from gtm_hit.models import Annotation, Assignment, GoldFrame, LayerFrame, PlantedFault, Save
from gtm_hit.scoring import truth
from gtm_hit.scoring.evidence import Evidence
from gtm_hit.scoring.plausibility import count_warnings

State = Assignment.State
CLICKED = Annotation.Origin.CLICKED.value

# What can be measured: the worker is done with it.
SUBMITTED = [State.SUBMITTED, State.ACCEPTED, State.RETURNED, State.REJECTED]


@dataclass
class Work:
    """What the saves of an assignment tell about how it was done."""

    edits: int = 0
    carried: int = 0
    untouched: int = 0


def measure(assignment: Assignment) -> Evidence:
    """A fixed number of queries, and one for each truth and each copy."""
    rows = people_in(assignment.layer_id)
    grid, work = assignment.layer.dataset.grid, how_it_was_done(assignment)
    own = in_metres(rows, grid)
    faults = list(PlantedFault.objects.filter(assignment=assignment).values_list("repaired", flat=True))
    heads = LayerFrame.objects.filter(layer=assignment.layer_id).values_list("seconds", flat=True)
    counted = Evidence(
        faults=sum(repaired is not None for repaired in faults),
        repaired=sum(bool(repaired) for repaired in faults),
        people=len(rows),
        seconds=round(sum(heads), 1),
        carried=work.carried,
        untouched=work.untouched,
        edits=work.edits,
        warnings=count_warnings(own, 1 / assignment.layer.dataset.frame_rate),
        finished=1,
    )
    return counted + against_gold(assignment, own, grid) + against_copies(assignment, own, grid)


def people_in(layer_id: int, **scope: Any) -> list[tuple[int, int, int]]:
    """Frame number, person and position."""
    found = Annotation.objects.filter(layer=layer_id, **scope).order_by("frame__number", "person")
    return list(found.values_list("frame__number", "person", "position"))


def in_metres(rows: Iterable[tuple[int, int, int]], grid: Grid) -> Annotations:
    numbers, persons, places = np.array(list(rows), np.int64).reshape(-1, 3).T
    return Annotations(numbers, grid.metres(places), persons)


def only(people: Annotations, numbers: Iterable[int]) -> Annotations:
    return people.take(np.flatnonzero(np.isin(people.frames, list(numbers))))


def against_gold(assignment: Assignment, own: Annotations, grid: Grid) -> Evidence:
    all_gold = GoldFrame.objects.filter(campaign=assignment.batch.campaign_id)
    by_truth: dict[int, dict[int, int]] = {
        truth_id: {} for truth_id in all_gold.order_by("truth").values_list("truth", flat=True).distinct()
    }
    mine = all_gold.filter(frame__batches=assignment.batch_id)
    for truth_id, frame_id, number in mine.values_list("truth_id", "frame_id", "frame__number"):
        by_truth[truth_id][frame_id] = number
    found = Evidence()
    for truth_id, frames in by_truth.items():
        # Asked for no frame as well: work without gold takes as many queries as work with it.
        known = in_metres(people_in(truth_id, frame__in=[*frames, 0]), grid)
        found += of_truth(truth.score(known, only(own, frames.values())), len(frames))
    return found


def of_truth(score: truth.TruthScore, frames: int) -> Evidence:
    return Evidence(
        gold_frames=frames,
        truth=score.truth,
        found=score.found,
        matched=score.matched,
        placed=score.placed,
        same=min(score.together, score.matched),
    )


def against_copies(assignment: Assignment, own: Annotations, grid: Grid) -> Evidence:
    """Everybody else who did the same frames; who is right stays open."""
    found = Evidence()
    for other in others(assignment).select_related("layer"):
        theirs = in_metres(people_in(other.layer_id), grid)
        agreed = 2 * len(match(own, theirs).distances)
        found += Evidence(shared=len(own) + len(theirs), agreed=agreed)
    return found


def others(assignment: Assignment) -> Any:
    batch = assignment.batch
    same = Assignment.objects.filter(
        batch__campaign=batch.campaign_id, batch__number=batch.number, state__in=SUBMITTED
    )
    return same.exclude(worker=assignment.worker_id).exclude(state=State.REJECTED)


def how_it_was_done(assignment: Assignment) -> Work:
    saves = Save.objects.filter(layer_frame__layer=assignment.layer_id).order_by("layer_frame", "revision")
    frames: dict[int, list[tuple[bool, dict[int, dict[str, Any]]]]] = {}
    for frame, worker, people in saves.values_list("layer_frame", "worker", "annotations"):
        state = {one["person"]: one for one in people}
        frames.setdefault(frame, []).append((worker is not None, state))
    work = Work()
    for states in frames.values():
        count_frame(states, work)
    return work


def count_frame(states: list[tuple[bool, dict[int, dict[str, Any]]]], work: Work) -> None:
    before: dict[int, dict[str, Any]] = {}
    first: dict[int, int] = {}  # where a program put whom
    for by_worker, people in states:
        if by_worker:
            work.edits += sum(is_edit(before.get(person), one) for person, one in people.items())
            work.edits += len(before.keys() - people.keys())
        for person, one in people.items():
            if one["origin"] != CLICKED:
                first.setdefault(person, one["position"])
        before = people
    of_worker = [people for by_worker, people in states if by_worker]
    last: dict[int, dict[str, Any]] = of_worker[-1] if of_worker else {}
    put = [person for person in last if person in first]
    work.carried += len(put)
    work.untouched += sum(last[person]["position"] == first[person] for person in put)


def is_edit(before: dict[str, Any] | None, after: dict[str, Any]) -> bool:
    """Placed by hand, or moved; to validate somebody where he stands is none."""
    if before is None:
        return bool(after["origin"] == CLICKED)
    return bool(before["position"] != after["position"])
