"""A conflict as somebody looks at it: both paths on the ground, and pictures around the time in between."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import or_

import numpy as np
from django.db.models import Q

from gtm_hit.models import Annotation, Dataset, Frame, Image, StitchConflict
from gtm_hit.ops.ground.coverage import table

PATH = 12  # frames of each side that are drawn on the ground
PICTURES = 3  # frames of each side that are shown in each view
VIEWS = 3
AROUND = 5.0  # metres in which other people are drawn
BEFORE, AFTER = "before", "after"


@dataclass(frozen=True)
class Place:
    frame: int  # number
    x: float  # metres
    y: float


@dataclass(frozen=True)
class Box:
    side: str  # BEFORE or AFTER
    box: list[int]  # xmin, ymin, xmax, ymax, pixels


@dataclass(frozen=True)
class Picture:
    frame: int
    camera: str
    width: int  # of the camera's pictures, pixels
    height: int
    light: str  # digests
    full: str
    boxes: list[Box]


@dataclass(frozen=True)
class Detail:
    before: list[Place]  # by frame
    after: list[Place]
    others: list[list[Place]]  # people nearby, in the same frames
    pictures: list[list[Picture]]  # a row per view, by frame


def detail(conflict: StitchConflict) -> Detail:
    dataset = conflict.stitching.dataset
    sides = {
        BEFORE: _path(dataset, conflict.before, Q(frame__number__lte=conflict.left_at), "-"),
        AFTER: _path(dataset, conflict.after, Q(frame__number__gte=conflict.came_at), ""),
    }
    before, after = sides[BEFORE], sides[AFTER]
    return Detail(before, after, _others(conflict, before + after), _pictures(dataset, sides))


def _path(dataset: Dataset, sources: Sequence[Sequence[int]], when: Q, order: str) -> list[Place]:
    """The mean place per frame, of all it was made of."""
    nobody = Q(pk__in=[])
    whose = reduce(or_, (Q(layer=layer, person=person) for layer, person in sources), nobody)
    rows = Annotation.objects.filter(whose, when).order_by(f"{order}frame__number")
    found = list(rows.values_list("frame__number", "position")[: PATH * len(sources)])
    places: dict[int, list[list[float]]] = defaultdict(list)
    metres = dataset.grid.metres([position for _, position in found]).tolist()
    for (frame, _), xy in zip(found, metres, strict=True):
        places[frame].append(xy)
    nearest = list(places.items())[:PATH]
    return [Place(frame, *np.mean(xy, axis=0).round(4).tolist()) for frame, xy in sorted(nearest)]


def _others(conflict: StitchConflict, own: Sequence[Place]) -> list[list[Place]]:
    if not own:
        return []
    rows = Annotation.objects.filter(
        layer=conflict.stitching.layer_id, frame__number__in={place.frame for place in own}
    ).order_by("person", "frame__number")
    found = list(rows.values_list("person", "frame__number", "position"))
    metres = conflict.stitching.dataset.grid.metres([position for _, _, position in found])
    middle = np.mean([(place.x, place.y) for place in own], axis=0)
    here = {(place.frame, place.x, place.y) for place in own}
    paths: dict[int, list[Place]] = defaultdict(list)
    for (person, frame, _), xy in zip(found, metres, strict=True):
        if np.hypot(*(xy - middle)) <= AROUND:
            paths[person].append(Place(frame, *xy.round(4).tolist()))
    return [
        path for path in paths.values() if not any((place.frame, place.x, place.y) in here for place in path)
    ]


def _pictures(dataset: Dataset, sides: dict[str, list[Place]]) -> list[list[Picture]]:
    shown = [(BEFORE, place) for place in sides[BEFORE][-PICTURES:]]
    shown += [(AFTER, place) for place in sides[AFTER][:PICTURES]]
    if not shown:
        return []
    # Where both are there, both are marked: two rectangles in one picture tell the most.
    frames = sorted({place.frame for _, place in shown})
    marked = [(side, place) for side, path in sides.items() for place in path if place.frame in frames]
    positions = dataset.grid.nearest(np.array([(place.x, place.y) for _, place in marked]))
    boxes, visible = table(dataset).rectangles(positions)
    images = _images(dataset, frames)
    rows = []
    for camera in _best_views(boxes, visible):
        seen, shows = boxes[:, camera], visible[:, camera]
        row = [
            _picture(images[frame, camera], frame, _marks(marked, frame, seen, shows))
            for frame in frames
            if (frame, camera) in images
        ]
        rows.append([picture for picture in row if picture.boxes])
    return [row for row in rows if row]


def _best_views(boxes: np.ndarray, visible: np.ndarray) -> list[int]:
    """Cameras that see them most often, then largest."""
    heights = np.where(visible, boxes[..., 3] - boxes[..., 1], 0).max(axis=0)
    counts = visible.sum(axis=0)
    order = np.lexsort((-heights, -counts)).tolist()
    return [camera for camera in order if counts[camera]][:VIEWS]


def _marks(
    marked: Sequence[tuple[str, Place]], frame: int, boxes: np.ndarray, visible: np.ndarray
) -> list[Box]:
    return [
        Box(side, boxes[row].tolist())
        for row, (side, place) in enumerate(marked)
        if place.frame == frame and visible[row]
    ]


def _images(dataset: Dataset, frames: Iterable[int]) -> dict[tuple[int, int], Image]:
    """By frame number and the camera's index."""
    wanted = Frame.objects.filter(dataset=dataset, number__in=list(frames))
    found = Image.objects.filter(frame__in=wanted).select_related("frame", "camera")
    return {(image.frame.number, image.camera.index): image for image in found}


def _picture(image: Image, frame: int, boxes: list[Box]) -> Picture:
    camera = image.camera
    return Picture(
        frame, camera.name, camera.width, camera.height, image.light_digest, image.full_digest, boxes
    )
