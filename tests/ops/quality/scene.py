"""Two layers of one dataset: people on crossing curves, and somebody's imperfect annotations of them."""

from __future__ import annotations

import numpy as np

from gtm_hit.metrics.annotations import Annotations
from gtm_hit.models import Annotation, Dataset, Layer, LayerFrame
from tests.metrics.scenes import crossing_people
from tests.work_scene import make_dataset, make_layer


def put(layer: Layer, people: Annotations, **values: float) -> None:
    """As annotations saved once in every frame of the dataset, at the nearest positions."""
    frames = {frame.number: frame for frame in layer.dataset.frames.all()}
    LayerFrame.objects.bulk_create(
        LayerFrame(layer=layer, frame=frame, revision=1) for frame in frames.values()
    )
    positions = layer.dataset.grid.nearest(people.xy)
    Annotation.objects.bulk_create(
        Annotation(layer=layer, frame=frames[frame], person=person, position=position, **values)
        for frame, person, position in zip(
            people.frames.tolist(), people.identities().tolist(), positions.tolist(), strict=True
        )
    )


def on_grid(dataset: Dataset, people: Annotations) -> Annotations:
    """The same people at the positions they are stored with."""
    xy = dataset.grid.metres(dataset.grid.nearest(people.xy))
    return Annotations(people.frames, xy, people.persons)


def two_layers(frames: int = 40) -> tuple[Layer, Layer]:
    dataset = make_dataset(frames=frames)
    truth, found = make_layer(dataset, "truth", Layer.Kind.GROUND_TRUTH), make_layer(dataset, "found")
    for layer, people in zip((truth, found), crossing_people(frames=frames), strict=True):
        put(layer, people)
    return truth, found


def walk(layer: Layer, person: int, start: tuple[float, float], step: tuple[float, float]) -> None:
    """One person in every frame, walking straight on."""
    numbers = np.array(layer.dataset.frames.values_list("number", flat=True))
    xy = np.array(start) + np.arange(len(numbers))[:, None] * np.array(step)
    put(layer, Annotations(numbers, xy, np.full(len(numbers), person)))
