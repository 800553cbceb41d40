"""Who is who within a run: its people linked over all frames."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from django.db import transaction
from numpy.typing import NDArray

from gtm_hit.geometry.grid import Grid
from gtm_hit.models import Frame, Proposal, ProposalFrame, ProposalRun
from gtm_hit.vision.link import FILLED, Linked, for_pace
from gtm_hit.vision.windows import linked_in_windows

Ids = NDArray[np.int64]
Floats = NDArray[np.float64]

ROWS_AT_ONCE = 1000


@dataclass(frozen=True, eq=False)
class _Seen:
    """Everybody of a run by frame; frames are counted along the dataset."""

    pks: Ids
    frames: Ids
    xy: Floats
    scores: Floats


def link_run(run: ProposalRun) -> int:
    """Give everybody the run proposes a track, fill short holes; the number of tracks."""
    numbers = Frame.objects.filter(dataset=run.dataset_id).order_by("number").values_list("pk", flat=True)
    places = {pk: index for index, pk in enumerate(numbers)}
    looked = dict(ProposalFrame.objects.filter(run=run).values_list("frame_id", "pk"))
    kept_of = {places[frame]: pk for frame, pk in looked.items()}
    with transaction.atomic():
        ProposalRun.objects.select_for_update(no_key=True).get(pk=run.pk)
        Proposal.objects.filter(proposal_frame__run=run, filled=True).delete()
        seen = _seen(run, {pk: index for index, pk in kept_of.items()})
        linked = linked_in_windows(seen.frames, seen.xy, for_pace(run.dataset.seconds_per_frame))
        _keep_tracks(seen, linked)
        _keep_filled(run.dataset.grid, kept_of, seen, linked)
    return len(np.unique(linked.tracks))


def is_linked(run: ProposalRun) -> bool:
    people = Proposal.objects.filter(proposal_frame__run=run)
    return people.filter(track__isnull=False).exists() or not people.exists()


def count(run: ProposalRun) -> int:
    tracks = Proposal.objects.filter(proposal_frame__run=run, track__isnull=False)
    return tracks.order_by().values("track").distinct().count()


def _seen(run: ProposalRun, index_of: dict[int, int]) -> _Seen:
    rows = Proposal.objects.filter(proposal_frame__run=run).order_by("pk")
    found = list(rows.values_list("pk", "proposal_frame", "x", "y", "score"))
    return _Seen(
        np.array([row[0] for row in found], dtype=np.int64),
        np.array([index_of[row[1]] for row in found], dtype=np.int64),
        np.array([row[2:4] for row in found], dtype=np.float64).reshape(-1, 2),
        np.array([row[4] for row in found], dtype=np.float64),
    )


def _keep_tracks(seen: _Seen, linked: Linked) -> None:
    own = linked.rows != FILLED
    track_of = dict(zip(linked.rows[own].tolist(), linked.tracks[own].tolist(), strict=True))
    certainty_of = dict(zip(linked.rows[own].tolist(), linked.certainty[own].tolist(), strict=True))
    rows = [
        Proposal(pk=pk, track=track_of.get(row), certainty=certainty_of.get(row, 1.0))
        for row, pk in enumerate(seen.pks.tolist())
    ]
    Proposal.objects.bulk_update(rows, ["track", "certainty"], batch_size=ROWS_AT_ONCE)


def _keep_filled(grid: Grid, kept_of: dict[int, int], seen: _Seen, linked: Linked) -> None:
    """Between two sightings; as likely as the less likely of them, and half as certain."""
    score_of = {
        (track, frame): float(seen.scores[row])
        for row, frame, track in zip(linked.rows, linked.frames.tolist(), linked.tracks.tolist(), strict=True)
        if row != FILLED
    }
    rows = []
    for at in np.flatnonzero(linked.rows == FILLED).tolist():
        frame, track, (x, y) = int(linked.frames[at]), int(linked.tracks[at]), linked.xy[at].tolist()
        position = int(grid.position([(x, y)])[0])
        beside = [score_of.get((track, near), 0.0) for near in (frame - 1, frame + 1)]
        if position >= 0 and frame in kept_of:
            rows.append(
                Proposal(
                    proposal_frame_id=kept_of[frame],
                    position=position,
                    x=x,
                    y=y,
                    score=min(beside),
                    method="linked",
                    filled=True,
                    track=track,
                    certainty=float(linked.certainty[at]),
                )
            )
    Proposal.objects.bulk_create(rows, batch_size=ROWS_AT_ONCE)
