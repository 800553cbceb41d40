"""What is said of somebody's work in the tutorial: right, or which mistake it is and what to do about it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from django.utils.translation import gettext as _

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid
from gtm_hit.models import Annotation, Dataset
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.tutorial.exercise import Exercise, Positions, between

NEAR_ENOUGH = 0.15 + 1e-6  # metres; six grid steps of 2.5 cm are not quite 0.15
CLOSE = 0.50  # metres from somebody: the click was meant for them
AT_FEET = 0.15  # of a box's height, from its lower end: who clicks there meant the ground
ALONG = math.cos(math.radians(25))  # of a camera's line of sight: the box was fitted to a head


class Mistake(StrEnum):
    FRAME = "frame"  # it is another frame
    NOTHING = "nothing"  # nothing was done yet
    BODY = "body"  # clicked on the body instead of the ground
    OTHER = "other"  # somebody else was marked
    HEAD = "head"  # the box was moved until it fitted the head
    OFF = "off"  # beside the feet
    GONE = "gone"  # somebody who stood right was removed
    EMPTY = "empty"  # the box with nobody in it is still there
    YELLOW = "yellow"  # moved or not, but not validated


@dataclass(frozen=True)
class Verdict:
    """`person`: whom it is about, if they have a box; `feet`: the position at which they should stand."""

    ok: bool
    message: str
    mistake: Mistake | None = None
    person: int | None = None
    feet: int | None = None


def right(message: str) -> Verdict:
    return Verdict(True, message)


def frame_missed(index: int) -> Verdict:
    words = _("This step is about frame %(place)d of 3.") % {"place": index + 1}
    return Verdict(False, words, Mistake.FRAME)


def judge_place(exercise: Exercise, dataset: Dataset, rows: dict[int, Row]) -> Verdict:
    feet = exercise.truth[0][exercise.missing]
    added = {person: row.position for person, row in rows.items() if person not in exercise.shown(0)}
    if not added:
        words = _("Nobody new yet. Click on the ground between the feet of the person in the ring.")
        return Verdict(False, words, Mistake.NOTHING, feet=feet)
    person = min(added, key=lambda each: distance(added[each], feet, dataset.grid))
    off = distance(added[person], feet, dataset.grid)
    if off <= NEAR_ENOUGH:
        return right(_("Right: now they have a box in every view that sees them."))
    others = [place for each, place in exercise.truth[0].items() if each != exercise.missing]
    if off > CLOSE and on_body(dataset, feet, added[person]):
        words = _(
            "That was a click on the body, so the box came to stand far behind. Click lower, on the ground "
            "between the shoes."
        )
        return Verdict(False, words, Mistake.BODY, person, feet)
    if off > CLOSE and float(between([added[person]], others, dataset.grid).min(initial=np.inf)) <= CLOSE:
        words = _("That is somebody else. Mark the person in the ring.")
        return Verdict(False, words, Mistake.OTHER, person, feet)
    return off_by(person, off, feet)


def judge_correct(exercise: Exercise, dataset: Dataset, rows: dict[int, Row]) -> Verdict:
    wrong = judge_person(exercise.shifted, exercise.truth[0], exercise.shifted_to, dataset, rows)
    return wrong or right(_("Right: the box stands where the person does."))


def judge_remove(exercise: Exercise, dataset: Dataset, rows: dict[int, Row]) -> Verdict:
    kept = exercise.shown(0).keys() - {exercise.invented}
    if gone := sorted(kept - rows.keys()):
        return missing(gone[0])
    if exercise.invented in rows:
        words = _("The box with nobody in it is still there.")
        return Verdict(False, words, Mistake.EMPTY)
    return right(_("Right: nobody stood there."))


def judge_next(exercise: Exercise, dataset: Dataset, rows: dict[int, Row]) -> Verdict:
    for person in exercise.carried:
        before = exercise.truth[0][person]
        if wrong := judge_person(person, exercise.truth[1], before, dataset, rows):
            return wrong
    return right(_("Right: everybody stands where the pictures show them."))


def judge_person(
    person: int, truth: Positions, before: int, dataset: Dataset, rows: dict[int, Row]
) -> Verdict | None:
    """What is wrong with somebody who was shown at `before`; None when nothing is."""
    row, feet = rows.get(person), truth[person]
    if row is None:
        return missing(person)
    if distance(row.position, feet, dataset.grid) > NEAR_ENOUGH:
        if row.position == before:
            words = _("Person %(person)d stands beside the box.") % {"person": person}
            return Verdict(False, words, Mistake.NOTHING, person, feet)
        return misplaced(person, row.position, feet, dataset)
    if row.state == Annotation.State.CARRIED:
        words = _("Person %(person)d is still yellow: look, and validate.") % {"person": person}
        return Verdict(False, words, Mistake.YELLOW, person)
    return None


def missing(person: int) -> Verdict:
    words = _("Person %(person)d was right, and is gone. Undo brings them back.") % {"person": person}
    return Verdict(False, words, Mistake.GONE, person)


def misplaced(person: int, at: int, feet: int, dataset: Dataset) -> Verdict:
    off = distance(at, feet, dataset.grid)
    camera = fitted_head(dataset, at, feet) if off <= CLOSE else None
    if camera is None:
        return off_by(person, off, feet)
    words = _(
        "Box %(person)d is %(cm)d cm off, along the line of sight of %(camera)s. All boxes are equally tall "
        "and may stand out over a head: only the feet count."
    )
    told = {"person": person, "cm": centimetres(off), "camera": camera.name}
    return Verdict(False, words % told, Mistake.HEAD, person, feet)


def off_by(person: int, off: float, feet: int) -> Verdict:
    words = _("Box %(person)d is %(cm)d cm from the feet; 15 cm are near enough.")
    return Verdict(False, words % {"person": person, "cm": centimetres(off)}, Mistake.OFF, person, feet)


def centimetres(metres: float) -> int:
    """Rounded up: what is too far never reads as near enough."""
    return math.ceil(100 * metres - 1e-6)


def distance(one: int, other: int, grid: Grid) -> float:
    """Metres on the ground."""
    return float(between([one], [other], grid)[0, 0])


def on_body(dataset: Dataset, feet: int, clicked: int) -> bool:
    """Whether some view shows a clicked position within the box of somebody, above the feet."""
    for camera in dataset.calibrated_cameras():
        boxes, seen = boxes_at(camera, dataset, [feet, clicked])
        if not seen.all():
            continue
        (left, top, right_side, bottom), clicked_box = boxes
        x, y = (clicked_box[0] + clicked_box[2]) / 2, clicked_box[3]
        if left <= x <= right_side and top <= y <= bottom - AT_FEET * (bottom - top):
            return True
    return False


def fitted_head(dataset: Dataset, at: int, feet: int) -> Camera | None:
    """The nearest camera along whose line of sight somebody was moved, if there is one."""
    here, there = dataset.grid.metres([at, feet])
    off = there - here
    along: list[tuple[float, Camera]] = []
    for camera in dataset.calibrated_cameras():
        towards = camera.centre[:2] - there
        away = float(np.hypot(*towards))
        cosine = abs(float(off @ towards)) / max(away * float(np.hypot(*off)), 1e-9)
        if cosine >= ALONG and boxes_at(camera, dataset, [feet])[1].all():
            along.append((away, camera))
    return min(along, key=lambda each: each[0])[1] if along else None


def boxes_at(camera: Camera, dataset: Dataset, positions: list[int]) -> tuple[np.ndarray, np.ndarray]:
    cylinder: Cylinder = dataset.cylinder
    rule: FootRule = dataset.rule
    return rectangles(camera, dataset.grid, cylinder, rule, np.array(positions))
