"""A tutorial with known truth: five people in the corners and the middle, walking 50 cm per frame."""

from __future__ import annotations

from typing import Any

from django.conf import settings

from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.tutorial import lesson
from tests.work_scene import make_dataset, make_layer, row, save

START = {1: 8_100, 2: 8_300, 3: 151_900, 4: 152_100, 5: 80_000}
STEP = 20  # positions along X per frame: 50 cm


def make_tutorial(images: bool = False) -> Dataset:
    dataset = make_dataset(settings.TUTORIAL_DATASET, frames=6, images=images)
    truth = make_layer(dataset, "truth", Layer.Kind.GROUND_TRUTH, hidden=True)
    for index, frame in enumerate(dataset.frames.order_by("number")):
        save(truth, frame, [row(person, place + STEP * index) for person, place in START.items()])
    return dataset


def solved(step: lesson.Step) -> tuple[int, list[dict[str, Any]]]:
    """Frame number and annotations of somebody who does the step right, and only that step."""
    loaded = lesson.load()
    exercise = loaded.exercise
    index = 1 if step is lesson.Step.NEXT else 0
    state = loaded.state(index)
    rows = {one.person: one.as_dict() for one in state.annotations}
    if step is lesson.Step.PLACE:
        rows[exercise.next_person] = row(exercise.next_person, exercise.truth[0][exercise.missing])
    if step is lesson.Step.CORRECT:
        rows[exercise.shifted] = row(exercise.shifted, exercise.truth[0][exercise.shifted])
    if step is lesson.Step.REMOVE:
        del rows[exercise.invented]
    if step is lesson.Step.NEXT:
        rows |= {person: row(person, exercise.truth[1][person]) for person in exercise.carried}
    return state.number, list(rows.values())
