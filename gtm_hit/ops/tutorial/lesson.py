"""The tutorial: three frames with prepared mistakes, judged against the hidden truth."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from django.conf import settings
from django.db import transaction
from django.utils import timezone
from numpy.typing import NDArray

from gtm_hit.geometry.cylinder import rectangles
from gtm_hit.models import Annotation, Dataset, Frame, Layer, Save, Worker
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.frames.row import Row
from gtm_hit.ops.frames.rules import checked
from gtm_hit.ops.frames.saving import FrameState
from gtm_hit.ops.tutorial.exercise import (
    Exercise,
    NoRoom,
    Positions,
    has_people,
    make_exercise,
)
from gtm_hit.ops.tutorial.judging import (
    Verdict,
    frame_missed,
    judge_correct,
    judge_next,
    judge_place,
    judge_remove,
)

FRAMES = 3
LARGE = 8  # a person of an eighth of the image's height can be judged without zooming


class Step(StrEnum):
    PLACE = "place"
    CORRECT = "correct"
    REMOVE = "remove"
    NEXT = "next"


class NoTutorial(OperationError, LookupError):
    """The tutorial's dataset is not there, or its truth has too few people."""


class StepsMissing(OperationError):
    def __init__(self, steps: list[str]) -> None:
        super().__init__(", ".join(steps))
        self.steps = steps


@dataclass(frozen=True)
class Tutorial:
    dataset: Dataset
    frames: list[Frame]
    exercise: Exercise

    def states(self) -> list[FrameState]:
        return [self.state(index) for index in range(len(self.frames))]

    def state(self, index: int) -> FrameState:
        yellow = self.exercise.yellow(index)
        people = sorted(self.exercise.shown(index).items())
        rows = [(Row.carried if person in yellow else Row)(person, position) for person, position in people]
        return FrameState(self.frames[index].number, 1, rows, False, False, None, "")


def load() -> Tutorial:
    """The tutorial of settings.TUTORIAL_DATASET; raises NoTutorial."""
    layer = hidden_truth()
    if layer is None:
        raise NoTutorial(f"no dataset {settings.TUTORIAL_DATASET!r} with a hidden truth")
    dataset, frames = layer.dataset, shown_frames()
    try:
        exercise = make_exercise(
            [frame.number for frame in frames],
            truth_of(layer, frames),
            dataset.grid,
            lambda places, others: clear_views(dataset, places, others),
        )
    except NoRoom as error:
        raise NoTutorial(str(error)) from error
    return Tutorial(dataset, frames, exercise)


def shown_frames() -> list[Frame]:
    frames = Frame.objects.filter(dataset__slug=settings.TUTORIAL_DATASET)
    return list(frames.order_by("number")[:FRAMES])


def hidden_truth() -> Layer | None:
    layers = Layer.objects.filter(hidden=True, kind=Layer.Kind.GROUND_TRUTH)
    layers = layers.filter(dataset__slug=settings.TUTORIAL_DATASET)
    return layers.select_related("dataset").order_by("pk").first()


def truth_of(layer: Layer, frames: list[Frame]) -> list[Positions]:
    """Everybody of each frame. A frame that was imported counts as it was then, whoever edited it since."""
    imported = Save.objects.filter(
        layer_frame__layer=layer, layer_frame__frame__in=frames, revision=1, user=None, worker=None
    )
    truth: dict[int, Positions] = {
        frame_id: {row["person"]: row["position"] for row in rows}
        for frame_id, rows in imported.values_list("layer_frame__frame_id", "annotations")
    }
    others = [frame.pk for frame in frames if frame.pk not in truth]
    present = Annotation.objects.filter(layer=layer, frame__in=others)
    for frame_id, person, position in present.values_list("frame_id", "person", "position"):
        truth.setdefault(frame_id, {})[person] = position
    return [truth.get(frame.pk, {}) for frame in frames]


def available() -> bool:
    """Whether there are people enough. Every page of a worker asks, so the exercise itself is not made."""
    layer = hidden_truth()
    return layer is not None and has_people(truth_of(layer, shown_frames()))


def clear_views(dataset: Dataset, places: list[int], others: list[int]) -> NDArray[np.int64]:
    """Cameras in which each place's rectangle is large, inside the image, and free of others' rectangles."""
    here, there = np.array(places), np.array(others)
    clear = np.zeros(len(places), dtype=np.int64)
    for camera in dataset.calibrated_cameras():
        boxes, visible = rectangles(camera, dataset.grid, dataset.cylinder, dataset.rule, here)
        crowd, seen = rectangles(camera, dataset.grid, dataset.cylinder, dataset.rule, there)
        low = np.maximum(boxes[:, None, :2], crowd[None, :, :2])
        high = np.minimum(boxes[:, None, 2:], crowd[None, :, 2:])
        meets = (low < high).all(axis=2) & seen & (here[:, None] != there)
        inside = (boxes[:, :2] >= 0).all(axis=1) & (boxes[:, 2:] < (camera.width, camera.height)).all(axis=1)
        large = boxes[:, 3] - boxes[:, 1] >= camera.height / LARGE
        clear += visible & inside & large & ~meets.any(axis=1)
    return clear


def check(worker: Worker, step: Step, number: int, annotations: object) -> Verdict:
    """Judge one step and remember it when it is right; raises NoTutorial or InvalidFrame."""
    tutorial = load()
    rows, _seconds = checked(annotations, tutorial.dataset.grid, done=False, nobody=False, seconds=0)
    verdict = judge(tutorial, step, number, rows)
    if verdict.ok:
        remember(worker, step)
    return verdict


def remember(worker: Worker, step: Step) -> None:
    with transaction.atomic():
        locked = Worker.objects.select_for_update(no_key=True).get(pk=worker.pk)
        if step not in locked.tutorial_steps:
            locked.tutorial_steps = [*locked.tutorial_steps, step.value]
            locked.save(update_fields=["tutorial_steps"])


def judge(tutorial: Tutorial, step: Step, number: int, rows: list[Row]) -> Verdict:
    index = 1 if step is Step.NEXT else 0
    if number != tutorial.frames[index].number:
        return frame_missed(index)
    judges = {
        Step.PLACE: judge_place,
        Step.CORRECT: judge_correct,
        Step.REMOVE: judge_remove,
        Step.NEXT: judge_next,
    }
    return judges[step](tutorial.exercise, tutorial.dataset, {row.person: row for row in rows})


def finish(worker: Worker) -> Worker:
    """Note that the worker did the tutorial; raises StepsMissing unless every step was judged right."""
    with transaction.atomic():
        locked = Worker.objects.select_for_update(no_key=True).get(pk=worker.pk)
        if missing := [step.value for step in Step if step.value not in locked.tutorial_steps]:
            raise StepsMissing(missing)
        if locked.tutorial_done_at is None:
            locked.tutorial_done_at = timezone.now()
            locked.save(update_fields=["tutorial_done_at"])
        return locked
