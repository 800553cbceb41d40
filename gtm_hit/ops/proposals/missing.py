"""Who is missing in a layer: listed, placed, or said to be nobody."""

from __future__ import annotations

import uuid
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from django.db.models import F
from django.utils.translation import gettext as _

from gtm_hit.geometry.grid import Grid
from gtm_hit.models import Frame, Layer, LayerFrame, PictureBoxes, Proposal, ProposalRun
from gtm_hit.ops.frames import saving
from gtm_hit.ops.frames.saving import Author
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.ground.rectangles import annotation_rectangles
from gtm_hit.ops.proposals import refusals, runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.pictures import pictures_of
from gtm_hit.ops.quality.layer_rows import LayerRows, read_layer
from gtm_hit.vision.boxes import as_array, overlaps
from gtm_hit.vision.missing import Area, Case, Flags, Marked, Seen, Why, find

MOST_FRAMES = 1000  # looked through at once
NEAR = 0.5  # metres: whoever looked at a place looked at this much around it
BOXED = 0.3  # of intersection over union, from which on a box shows somebody


@dataclass(frozen=True)
class Missing:
    """One place to look at; `frame` is the frame's number."""

    frame: int
    why: Why
    position: int
    x: float
    y: float
    person: int | None
    weight: float

    @property
    def is_absence(self) -> bool:
        """Somebody should be there; else somebody should not."""
        return self.why in {Why.PROPOSED, Why.HOLE, Why.ENDS}

    @property
    def words(self) -> str:
        return _words(self.why) % {"person": self.person}

    def as_dict(self) -> dict[str, Any]:
        return {**vars(self), "why": self.why.value, "words": self.words}


@dataclass(frozen=True)
class MissingReport:
    """`run` is None where nothing is proposed: then only holes tell. `later`: frames not looked at."""

    run: ProposalRun | None
    frames: int
    later: int
    places: list[Missing]


def missing(layer: Layer, start: int = 0) -> MissingReport:
    """From frame number `start` on, the likeliest first, without the places somebody looked at."""
    frames = list(_saved(layer).filter(number__gte=start).order_by("number"))
    looked, later = frames[:MOST_FRAMES], max(len(frames) - MOST_FRAMES, 0)
    run = runs.in_use(layer.dataset)
    if not looked:
        return MissingReport(run, 0, 0, [])
    index_of = {frame.pk: at for at, frame in enumerate(looked)}
    rows = read_layer(layer).within(np.array([frame.number for frame in looked]))
    marked = _marked(layer, rows, looked, run)
    seen = _seen(run, index_of)
    found = find(marked, seen, len(looked), _area(layer.dataset.grid))
    return MissingReport(run, len(looked), later, _unlooked(layer, looked, found))


def _saved(layer: Layer) -> Any:
    saved = LayerFrame.objects.filter(layer=layer, revision__gte=1)
    return Frame.objects.filter(pk__in=saved.values("frame"))


def _marked(layer: Layer, rows: LayerRows, frames: Sequence[Frame], run: ProposalRun | None) -> Marked:
    numbers = np.array([frame.number for frame in frames])
    return Marked(
        np.searchsorted(numbers, rows.frames),
        layer.dataset.grid.metres(rows.positions),
        rows.persons,
        _boxed(layer, rows, frames, run),
    )


def _boxed(layer: Layer, rows: LayerRows, frames: Sequence[Frame], run: ProposalRun | None) -> Flags | None:
    """Whether a box of any view shows the person; None where no detector has looked."""
    boxes = _boxes(frames, run)
    if not boxes:
        return None
    dataset = layer.dataset
    cameras = dataset.calibrated_cameras()
    rectangles, visible = annotation_rectangles(
        dataset, cameras, table(dataset), rows.positions, rows.heights, rows.radii
    )
    shown = np.zeros(len(rows), dtype=bool)
    for frame in frames:
        there = np.flatnonzero(rows.frames == frame.number)
        views = boxes.get(frame.pk)
        if views is None:
            shown[there] = True  # not looked at: nothing can be said
            continue
        for number, camera in enumerate(cameras):
            found = views.get(camera.name)
            if found is not None and len(found) and len(there):
                best = overlaps(rectangles[there, number].astype(np.float64), found).max(axis=1)
                shown[there] |= (best >= BOXED) & visible[there, number]
    return shown


def _boxes(frames: Sequence[Frame], run: ProposalRun | None) -> Mapping[int, Mapping[str, Any]]:
    """By frame id and camera, of frames the run's detector has seen in every view."""
    if run is None or not run.model:
        return {}
    pictures = pictures_of(frames)
    wanted = {digest for each in pictures.values() for digest in each.digests.values()}
    kept: dict[str, Any] = {}
    for row in PictureBoxes.objects.filter(model=run.model, picture__in=wanted).iterator():
        kept[row.picture] = as_array(row.boxes)
    return {
        frame: {name: kept[digest] for name, digest in each.digests.items()}
        for frame, each in pictures.items()
        if each.digests and all(digest in kept for digest in each.digests.values())
    }


def _seen(run: ProposalRun | None, index_of: Mapping[int, int]) -> Seen:
    rows = Proposal.objects.filter(proposal_frame__run=run) if run else Proposal.objects.none()
    rows = rows.annotate(frame=F("proposal_frame__frame")).order_by("pk")
    found = [row for row in rows.values_list("frame", "x", "y", "score", "track") if row[0] in index_of]
    return Seen(
        np.array([index_of[row[0]] for row in found], dtype=np.int64),
        np.array([row[1:3] for row in found], dtype=np.float64).reshape(-1, 2),
        np.array([row[3] for row in found], dtype=np.float64),
        np.array([-1 if row[4] is None else row[4] for row in found], dtype=np.int64),
    )


def _area(grid: Grid) -> Area:
    width, length = grid.extent
    return Area(grid.origin_x, grid.origin_y, grid.origin_x + width, grid.origin_y + length)


def _unlooked(layer: Layer, frames: Sequence[Frame], found: Sequence[Case]) -> list[Missing]:
    grid = layer.dataset.grid
    looked_at = refusals.refused_in(layer, [frame.pk for frame in frames])
    positions = grid.position(np.array([(case.x, case.y) for case in found]).reshape(-1, 2)).tolist()
    places = []
    for case, position in zip(found, positions, strict=True):
        frame = frames[case.frame]
        refused = grid.metres(looked_at.get(frame.pk, []))
        away = np.hypot(refused[:, 0] - case.x, refused[:, 1] - case.y)
        if position >= 0 and not (away < NEAR).any():
            places.append(Missing(frame.number, case.why, position, case.x, case.y, case.person, case.weight))
    return places


def place(layer: Layer, number: int, position: int, person: int | None, author: Author) -> int:
    """Mark the missing person there, under their number or a new one; the number.

    Raises ProposalError, and what a save raises.
    """
    frame = _frame(layer, number)
    state = saving.read_frame(layer, frame)
    taken = {row.person for row in state.annotations}
    if person in taken:
        raise ProposalError(_("Person %(person)d is in this frame already.") % {"person": person})
    marked = saving.next_person(layer) if person is None else person
    people = [row.as_dict() for row in state.annotations]
    people.append({"person": marked, "position": position, "origin": "proposed"})
    saving.save_frame(layer, frame, author, uuid.uuid4(), state.revision, people, done=state.done)
    return marked


def dismiss(layer: Layer, number: int, position: int, author: Author) -> None:
    """Somebody looked: nobody is there, or it is right as it is."""
    refusals.refuse(layer, _frame(layer, number), position, author)


def _frame(layer: Layer, number: int) -> Frame:
    frame = Frame.objects.filter(dataset=layer.dataset_id, number=number).first()
    if frame is None:
        raise ProposalError(_("There is no frame %(number)d.") % {"number": number})
    return frame


def _words(why: Why) -> str:
    return {
        Why.PROPOSED: _("somebody seems to stand here, and nobody is marked"),
        Why.HOLE: _("person %(person)s is marked before and after, not in this frame"),
        Why.ENDS: _("person %(person)s is in the frame beside this one and was not near the border"),
        Why.UNSUPPORTED: _("person %(person)s is marked here, and no view shows anybody"),
        Why.STILL: _("person %(person)s stands where they stood before, and the picture has moved on"),
    }[why]
