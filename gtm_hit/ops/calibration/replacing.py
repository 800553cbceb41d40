"""Looking at what a new calibration would change, and changing it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import islice
from typing import Any

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import Count, F, Max

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder
from gtm_hit.geometry.table import table_digest
from gtm_hit.models import Annotation, Calibration, Dataset, Image, Layer, Save
from gtm_hit.ops.calibration import comparison as compared
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.calibration.comparison import Comparison, Moved, Person
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.jobs.progress import Progress

PEOPLE_TOGETHER = 20_000
COMPARING = "comparing boxes"
LATTICE = 7  # positions along each side that stand in for people where nobody is annotated


class ReplacementError(OperationError, ValueError):
    """The calibration cannot be put in place now; says why."""


def preview(dataset: Dataset, cameras: Sequence[Camera], progress: Progress) -> dict[str, Any]:
    """What putting `cameras` in place would do to every box, as JSON values.

    Positions of annotations stay as they are; nothing is written, no rectangle table either.
    """
    state = state_of(dataset)
    comparison = Comparison(
        compared.Calibration(dataset.calibrated_cameras(), dataset.grid, dataset.rule),
        compared.Calibration(cameras, dataset.grid, dataset.rule),
    )
    total = Annotation.objects.filter(layer__dataset=dataset).count()
    people = people_of(dataset)
    progress(COMPARING, 0, total)
    while block := list(islice(people, PEOPLE_TOGETHER)):
        comparison.add(block)
        # Somebody may annotate meanwhile; the state tells, the bar need not.
        progress(COMPARING, min(comparison.people, total), total)
    return {
        "state": state,
        "annotations": comparison.people,
        "cameras": comparison.cameras(),
        "worst": [_worst(moved) for moved in comparison.worst],
        "picture": _picture(dataset, comparison),
    }


def replace_calibration(
    dataset: Dataset,
    cameras: Sequence[Camera],
    seen: dict[str, Any],
    source: str = "",
    user: User | None = None,
    report: dict[str, Any] | None = None,
) -> Calibration:
    """Put the cameras of a preview in place; what was there before stays under its number.

    Raises ReplacementError when annotations or calibration are not what they were for the preview `seen`.
    """
    with transaction.atomic():
        dataset = Dataset.objects.select_for_update().get(pk=dataset.pk)
        if state_of(dataset) != seen["state"]:
            raise ReplacementError(
                "Annotations or calibration have changed since these boxes were compared. Compare again."
            )
        if dataset.calibration_id is None:
            versions.put_in_place(dataset, dataset.calibrated_cameras(), versions.NOT_KNOWN)
        for row, camera in zip(dataset.cameras.select_for_update(), cameras, strict=True):
            row.matrix, row.distortion = camera.matrix.tolist(), camera.distortion.tolist()
            row.rvec, row.tvec = camera.rvec.tolist(), camera.tvec.tolist()
            row.model = camera.model.value
            row.save(update_fields=["matrix", "distortion", "rvec", "tvec", "model"])
        # The next one who opens the dataset need not wait for it; should it fail, he makes it.
        transaction.on_commit(partial(table, dataset, cameras=cameras), robust=True)
        return versions.put_in_place(dataset, cameras, source, user, report)


def state_of(dataset: Dataset) -> list[Any]:
    """Changes with every save, every layer removed, and every change of cameras, grid or cylinder."""
    digest = table_digest(dataset.calibrated_cameras(), dataset.grid, dataset.cylinder, dataset.rule)
    saves = Save.objects.filter(layer_frame__layer__dataset=dataset).aggregate(Count("pk"), Max("pk"))
    people = Annotation.objects.filter(layer__dataset=dataset).aggregate(Count("pk"), Max("pk"))
    return [digest, *saves.values(), *people.values()]


def people_of(dataset: Dataset, every: int = 1, **chosen: Any) -> Iterator[Person]:
    """Annotations of all layers, in the order they were made; with `every` that part of them only."""
    usual = dataset.cylinder
    rows = Annotation.objects.filter(layer__dataset=dataset, **chosen).order_by("pk")
    if every > 1:
        rows = rows.annotate(rest=F("pk") % every).filter(rest=0)
    fields = ("layer__name", "frame__number", "person", "position", "radius", "height")
    for layer, frame, person, position, radius, height in rows.values_list(*fields).iterator(PEOPLE_TOGETHER):
        size = usual if radius is height is None else Cylinder(radius or usual.radius, height or usual.height)
        yield Person(layer, frame, person, position, size)


def _worst(moved: Moved) -> dict[str, Any]:
    person = moved.person
    return {
        "shift": moved.shift,
        "layer": person.layer,
        "frame": person.frame,
        "person": person.person,
        "camera": moved.camera,
        "before": moved.before,
        "after": moved.after,
    }


def _picture(dataset: Dataset, comparison: Comparison) -> dict[str, Any]:
    """The fullest frame of any layer, hidden ones last, with its boxes before and after.

    A lattice where nobody is annotated.
    """
    fullest = (
        Annotation.objects.filter(layer__dataset=dataset, layer__unfinished=False)
        .values("layer", "frame")
        .annotate(people=Count("pk"))
        .order_by("layer__hidden", "-people", "frame__number")
        .first()
    )
    if fullest is None:
        frame, layer, people = dataset.frames.first(), None, _lattice(dataset)
    else:
        frame = dataset.frames.get(pk=fullest["frame"])
        layer = Layer.objects.get(pk=fullest["layer"]).name
        people = list(people_of(dataset, layer=fullest["layer"], frame=frame))
    images = Image.objects.filter(frame=frame).order_by("camera__index")
    return {
        "frame": frame.number if frame else None,
        "layer": layer,
        "images": list(images.values_list("light_digest", flat=True)),
        "before": _drawn(*comparison.before.boxes(people)),
        "after": _drawn(*comparison.after.boxes(people)),
    }


def _lattice(dataset: Dataset) -> list[Person]:
    grid = dataset.grid
    return [
        Person(
            "",
            0,
            0,
            row * grid.rows // LATTICE * grid.columns + column * grid.columns // LATTICE,
            dataset.cylinder,
        )
        for row in range(LATTICE)
        for column in range(LATTICE)
    ]


def _drawn(boxes: Any, visible: Any) -> list[list[list[int]]]:
    """Per camera the boxes that are visible."""
    return [boxes[visible[:, camera], camera].tolist() for camera in range(boxes.shape[1])]
