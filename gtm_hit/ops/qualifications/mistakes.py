"""What a worker is shown after a try: every mistake, worst first, in the pictures where it is seen best."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from django.utils.translation import gettext as _

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, rectangles
from gtm_hit.models import Annotation, Dataset, QualificationAttempt
from gtm_hit.ops.qualifications.judging import Sides, sides
from gtm_hit.scoring.truth import Mistake, MistakeKind, mistakes

MOST_SHOWN = 30
CROPS = 3  # pictures of each
INSIDE = 0.6  # of a rectangle that has to be in the picture
MARGIN = 0.45  # around the rectangles, of the larger one's height
LEAST = 120  # pixels

Box = tuple[int, int, int, int]
"""x, y, width, height in pixels."""


@dataclass(frozen=True)
class Crop:
    camera: int  # index
    name: str
    region: Box
    truth: Box | None
    found: Box | None


@dataclass(frozen=True)
class ShownMistake:
    kind: str
    frame: int
    sentence: str
    crops: list[Crop]


def shown_mistakes(attempt: QualificationAttempt) -> tuple[list[ShownMistake], int]:
    """The worst ones and how many there are in all; only of a try that is judged."""
    if attempt.passed is None:
        return [], 0
    both = sides(attempt)
    made = mistakes(both.truth, both.found)
    dataset = attempt.qualification.dataset
    cameras = dataset.calibrated_cameras()
    return [shown(one, both, dataset, cameras) for one in made[:MOST_SHOWN]], len(made)


def shown(one: Mistake, both: Sides, dataset: Dataset, cameras: Sequence[Camera]) -> ShownMistake:
    true = None if one.truth is None else both.truth_rows[one.truth]
    found = None if one.found is None else both.found_rows[one.found]
    crops = [crop for camera in cameras if (crop := crop_in(camera, dataset, true, found))]
    crops.sort(key=lambda crop: -(crop.truth or crop.found or (0, 0, 0, 0))[3])
    return ShownMistake(one.kind.value, one.frame, sentence(one, both), crops[:CROPS])


def sentence(one: Mistake, both: Sides) -> str:
    match one.kind:
        case MistakeKind.MISSED:
            return _("Somebody stands here whom you did not mark.")
        case MistakeKind.EXTRA:
            return _("Nobody stands here: your box has nobody in it.")
        case MistakeKind.OFF:
            metres = one.distance or 0.0
            return _("Your box stands %(metres).2f m from the person's feet.") % {"metres": metres}
    now = both.found_rows[one.found or 0].person
    text = _("You called this person %(before)d before; here it is %(now)d.")
    return text % {"before": one.before, "now": now}


def crop_in(
    camera: Camera, dataset: Dataset, true: Annotation | None, found: Annotation | None
) -> Crop | None:
    """None where the person cannot be seen well."""
    boxes = [box_of(camera, dataset, row) for row in (true, found)]
    shown = [box for box in boxes if box is not None]
    leading = boxes[0] if true is not None else boxes[1]
    if leading is None or inside(leading, camera) < INSIDE:
        return None
    return Crop(camera.index, camera.name, region_around(shown, camera), boxes[0], boxes[1])


def box_of(camera: Camera, dataset: Dataset, row: Annotation | None) -> Box | None:
    if row is None:
        return None
    usual = dataset.cylinder
    size = Cylinder(row.radius or usual.radius, row.height or usual.height)
    found, visible = rectangles(camera, dataset.grid, size, dataset.rule, [row.position])
    if not visible[0]:
        return None
    left, top, right, bottom = found[0].tolist()
    return left, top, right - left, bottom - top


def inside(box: Box, camera: Camera) -> float:
    """Share of the box that is in the picture."""
    left, top, width, height = box
    across = max(0, min(left + width, camera.width) - max(left, 0))
    down = max(0, min(top + height, camera.height) - max(top, 0))
    return across * down / max(1, width * height)


def region_around(boxes: Sequence[Box], camera: Camera) -> Box:
    """As wide as high, with room around, within the picture."""
    edges = np.array([(x, y, x + width, y + height) for x, y, width, height in boxes])
    low, high = edges[:, :2].min(axis=0), edges[:, 2:].max(axis=0)
    side = min(max(int((high - low).max() * (1 + MARGIN)), LEAST), camera.width, camera.height)
    middle = (low + high) / 2
    left = int(np.clip(middle[0] - side / 2, 0, camera.width - side))
    top = int(np.clip(middle[1] - side / 2, 0, camera.height - side))
    return left, top, side, side
