"""Looking at frames and keeping what was found, frame by frame: nothing is lost, nothing is done twice."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from django.db import transaction

from gtm_hit.models import Dataset, Frame, Proposal, ProposalFrame, ProposalRun
from gtm_hit.ops.jobs.progress import Progress, no_progress
from gtm_hit.ops.proposals import foregrounds, tracks
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.pictures import StoredPictures, pictures_of
from gtm_hit.vision import people as found_people
from gtm_hit.vision.masks import Masks
from gtm_hit.vision.people import FrameProposals

LOOKING = "looking for people"
GROUP = 40  # frames that share a background
SAME_SIZE = 0.2  # metres: nearer to the usual person nobody has a size of their own


class Looker(Protocol):
    """Finds people in a frame's pictures."""

    def prepare(self, group: Sequence[StoredPictures]) -> None:
        """Learn what frames near each other have in common."""

    def look(self, pictures: StoredPictures) -> FrameProposals: ...

    def foregrounds(self) -> Masks:
        """Of the frame looked at last; empty where no background is known."""


@dataclass(frozen=True)
class Proposed:
    frames: int  # looked at now
    known: int  # looked at before
    people: int
    tracks: int


@dataclass(frozen=True)
class _Group:
    """Frames that follow each other, and those of them that are still to be looked at."""

    pictures: Mapping[int, StoredPictures]  # by frame id
    open_frames: Sequence[Frame]


def propose(run: ProposalRun, looker: Looker, progress: Progress = no_progress) -> Proposed:
    """Look at every frame that the run has not, or whose pictures changed since; then link everybody.

    What `progress` raises ends it between two frames: those looked at are kept, and another call goes on.
    """
    looked = known = 0
    while True:
        frames = list(Frame.objects.filter(dataset=run.dataset_id).order_by("number"))
        groups = list(_groups(run, frames))
        if not any(pictures for group in groups for pictures in group.pictures.values()):
            raise ProposalError("The dataset has no pictures to look at.")
        left = sum(len(group.open_frames) for group in groups)
        known = known if looked else len(frames) - left
        if not left:
            break  # else: frames may have arrived while these were looked at
        looked += _look_at_all(run, looker, groups, len(frames), progress)
    linked = tracks.link_run(run) if looked or not tracks.is_linked(run) else tracks.count(run)
    people = Proposal.objects.filter(proposal_frame__run=run).count()
    return Proposed(looked, known, people, linked)


def _look_at_all(
    run: ProposalRun, looker: Looker, groups: Sequence[_Group], total: int, progress: Progress
) -> int:
    """The number of frames looked at."""
    left = sum(len(group.open_frames) for group in groups)
    done = total - left
    progress(LOOKING, done, total)
    for group in groups:
        if group.open_frames:
            looker.prepare([pictures for pictures in group.pictures.values() if pictures])
        for frame in group.open_frames:
            _look(run, frame, group.pictures[frame.pk], looker)
            done += 1
            progress(LOOKING, done, total)
    return left


def _groups(run: ProposalRun, frames: Sequence[Frame]) -> Iterator[_Group]:
    looked = dict(ProposalFrame.objects.filter(run=run).values_list("frame_id", "pictures"))
    for start in range(0, len(frames), GROUP):
        together = frames[start : start + GROUP]
        pictures = pictures_of(together)
        yield _Group(
            pictures, [frame for frame in together if looked.get(frame.pk) != pictures[frame.pk].digest]
        )


def _look(run: ProposalRun, frame: Frame, pictures: StoredPictures, looker: Looker) -> None:
    began = time.perf_counter()
    found = looker.look(pictures) if pictures else FrameProposals(())
    foregrounds.keep(run, pictures.digest, looker.foregrounds())  # first: whoever finds the frame finds them
    keep(run, frame, pictures.digest, found, time.perf_counter() - began)


def keep(run: ProposalRun, frame: Frame, pictures: str, found: FrameProposals, seconds: float) -> None:
    """All of a frame at once, in place of what the run knew of it: a repetition changes nothing."""
    suspicious = [
        {"camera": alarm.camera, "metres": _or_none(alarm.metres), "why": alarm.why}
        for alarm in found.suspicious
    ]
    with transaction.atomic():
        ProposalRun.objects.select_for_update(no_key=True).get(pk=run.pk)
        values = {"pictures": pictures, "suspicious": suspicious, "seconds": seconds}
        kept, _made = ProposalFrame.objects.update_or_create(run=run, frame=frame, defaults=values)
        Proposal.objects.filter(proposal_frame=kept).delete()
        Proposal.objects.bulk_create(_rows(run.dataset, kept, found))


def _rows(dataset: Dataset, kept: ProposalFrame, found: FrameProposals) -> list[Proposal]:
    """Of everybody who stands on the grid."""
    xy = np.array([(one.x, one.y) for one in found.people], dtype=np.float64).reshape(-1, 2)
    positions = dataset.grid.position(xy).tolist()
    cylinder = dataset.cylinder
    return [
        Proposal(
            proposal_frame=kept,
            position=position,
            x=one.x,
            y=one.y,
            height=_own(one.height, cylinder.height),
            radius=_own(one.radius, cylinder.radius),
            score=min(max(one.score, 0.0), 1.0),
            method=one.method,
            seated=one.seated,
            evidence=found_people.as_json(one)["evidence"],
        )
        for one, position in zip(found.people, positions, strict=True)
        if position >= 0
    ]


def _own(value: float, usual: float) -> float | None:
    return None if abs(value - usual) < SAME_SIZE else value


def _or_none(value: float) -> Any:
    return None if value != value else value
