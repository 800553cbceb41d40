"""Somebody marked roughly is put where the pictures show them: one of a frame, or everybody of a layer."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from django.utils.translation import gettext as _

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.grid import Grid
from gtm_hit.models import Dataset, Frame, Layer, Proposal, ProposalFrame, ProposalRun
from gtm_hit.ops.frames import saving
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.frames.saving import Author
from gtm_hit.ops.jobs.progress import Progress, no_progress
from gtm_hit.ops.proposals import foregrounds, runs
from gtm_hit.ops.proposals.boxes import known_boxes
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.pictures import StoredPictures, pictures_of
from gtm_hit.vision.boxes import Box
from gtm_hit.vision.masks import Masks
from gtm_hit.vision.snap import USUAL, Marks, snap, with_unmarked

CERTAIN = 0.7  # of a proposal's score: somebody is there
UNSEEN = "unseen"  # no program has looked at the frame
SNAPPING = "finding where people stand"
GROUP = 40  # frames whose pictures are asked for together


@dataclass(frozen=True)
class Mark:
    position: int
    height: float | None = None  # metres; None: as tall as usual


@dataclass(frozen=True)
class SnappedMark:
    """`refused` says why somebody stays: unseen, nothing, small, near; empty if they move."""

    position: int
    metres: float
    gain: float
    refused: str = ""
    background: bool = False  # the foreground of the run had a say; else boxes alone


@dataclass(frozen=True, eq=False)
class Sights:
    """What is known of one frame: boxes by camera, and pictures that are not the background."""

    cameras: Mapping[str, Camera]
    boxes: Mapping[str, list[Box]]
    foregrounds: Masks
    proposed: Sequence[Mark] = ()


def snap_mark(layer: Layer, frame: Frame, mark: Mark, others: Sequence[Mark]) -> SnappedMark:
    """Changes nothing; by what the run shown to annotators has kept of the frame. Raises ProposalError."""
    for each in (mark, *others):
        if not 0 <= each.position < layer.dataset.grid.count:
            raise ProposalError(_("Position %(n)d is not on the grid.") % {"n": each.position})
    run = runs.in_use(layer.dataset)
    sights = _sights(run, frame, pictures_of([frame])[frame.pk]) if run else None
    return snapped(layer.dataset, sights, mark, others)


def snapped(dataset: Dataset, sights: Sights | None, mark: Mark, others: Sequence[Mark]) -> SnappedMark:
    """Proposals explain the boxes of those who are not marked yet: else theirs would pull the first mark."""
    if sights is None:
        return SnappedMark(mark.position, 0.0, 0.0, UNSEEN)
    grid = dataset.grid
    bodies, proposed = _bodies(grid, (mark, *others)), _bodies(grid, sights.proposed)
    marks = with_unmarked(Marks(bodies[0], bodies[1:]), proposed)
    found = snap(marks, sights.boxes, sights.cameras, sights.foregrounds)
    place = np.array([(found.x, found.y)])
    position = int(grid.position(place)[0])
    if found.refused is not None or position < 0 or position in {each.position for each in others}:
        return SnappedMark(mark.position, 0.0, found.gain, found.refused or "near", bool(sights.foregrounds))
    metres = float(np.hypot(*(place[0] - bodies[0, :2])))
    return SnappedMark(position, metres, found.gain, background=bool(sights.foregrounds))


def _bodies(grid: Grid, marks: Sequence[Mark]) -> np.ndarray:
    """(N, 3): x, y, height."""
    xy = grid.metres([each.position for each in marks]).reshape(-1, 2)
    return np.column_stack((xy, [each.height or USUAL for each in marks]))


def _sights(run: ProposalRun, frame: Frame, pictures: StoredPictures) -> Sights | None:
    """None where the run has looked at no picture of the frame."""
    boxes = known_boxes(pictures, run.model) if run.model else {}
    looked = ProposalFrame.objects.filter(run=run, frame=frame).first()
    wrong = {each["camera"] for each in looked.suspicious} if looked else set()
    cameras = {each.name: each for each in run.dataset.calibrated_cameras() if each.name not in wrong}
    known = {name: found for name, found in boxes.items() if name in cameras}
    seen = foregrounds.kept(run, pictures.digest)
    masks = {name: mask for name, mask in seen.items() if name in cameras}
    sure = looked.people.filter(score__gte=CERTAIN, filled=False) if looked else Proposal.objects.none()
    proposed = [Mark(*values) for values in sure.values_list("position", "height")]
    return Sights(cameras, known, masks, proposed) if known or masks else None


@dataclass(frozen=True)
class LayerSnapped:
    frames: int
    people: int
    moved: int
    metres: float  # moved, on average
    unseen: int  # frames at which the run has not looked
    boxes_alone: int  # frames of which the run has kept no foreground


def snap_layer(layer: Layer, author: Author, progress: Progress = no_progress) -> LayerSnapped:
    """Everybody of a layer, one save for each frame in which somebody moves; again: hardly anybody does.

    Raises ProposalError, and what a save raises.
    """
    run = runs.in_use(layer.dataset)
    if run is None:
        raise ProposalError(_("Nothing is proposed for this dataset, so there are no boxes to go by."))
    frames = list(layer.dataset.frames.filter(annotations__layer=layer).distinct().order_by("number"))
    people, metres = 0, []
    unseen = boxes_alone = 0
    for done, (frame, sights) in enumerate(_all_sights(run, frames), start=1):
        rows = saving.read_frame(layer, frame)
        people += len(rows.annotations)
        unseen += sights is None
        boxes_alone += sights is not None and not sights.foregrounds
        moved = _moved(layer, sights, rows.annotations)
        if moved:
            metres += [away for _row, away in moved.values()]
            kept = [moved.get(row.person, (row, 0.0))[0].as_dict() for row in rows.annotations]
            saving.save_frame(layer, frame, author, uuid.uuid4(), rows.revision, kept, done=rows.done)
        progress(SNAPPING, done, len(frames))
    average = float(np.mean(metres)) if metres else 0.0
    return LayerSnapped(len(frames), people, len(metres), average, unseen, boxes_alone)


def _moved(layer: Layer, sights: Sights | None, rows: Sequence[Row]) -> dict[int, tuple[Row, float]]:
    """By person: whoever moves, one after the other, each with all others as they stand by then."""
    now = {row.person: row for row in rows}
    moved: dict[int, tuple[Row, float]] = {}
    for row in rows:
        others = [Mark(each.position, each.height) for each in now.values() if each.person != row.person]
        found = snapped(layer.dataset, sights, Mark(row.position, row.height), others)
        if not found.refused and found.position != row.position:
            now[row.person] = replace(row, position=found.position)
            moved[row.person] = (now[row.person], found.metres)
    return moved


def _all_sights(run: ProposalRun, frames: Sequence[Frame]) -> Iterator[tuple[Frame, Sights | None]]:
    for start in range(0, len(frames), GROUP):
        together = frames[start : start + GROUP]
        pictures = pictures_of(together)
        for frame in together:
            yield frame, _sights(run, frame, pictures[frame.pk])
