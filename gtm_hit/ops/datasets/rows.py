"""Rows of an import, many at a time. The same invariants as `frames.saving.save_frame` keeps one by one."""

from __future__ import annotations

import uuid
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice

from django.db import transaction

from gtm_hit.geometry.camera import Camera as CalibratedCamera
from gtm_hit.models import Annotation, Camera, Dataset, Frame, Image, Layer, LayerFrame, Save
from gtm_hit.ops.calibration.versions import in_place_id
from gtm_hit.ops.datasets.annotations import ImportedFrame
from gtm_hit.ops.datasets.insert import insert
from gtm_hit.ops.datasets.pictures import Key
from gtm_hit.ops.files.images import Derivatives
from gtm_hit.ops.frames.row import FIELDS

ROWS_AT_ONCE = 2000
FRAMES_AT_ONCE = 500  # with all their people in memory


def add_cameras(dataset: Dataset, cameras: Sequence[CalibratedCamera]) -> None:
    Camera.objects.bulk_create(
        Camera(
            dataset=dataset,
            index=camera.index,
            name=camera.name,
            width=camera.width,
            height=camera.height,
            matrix=camera.matrix.tolist(),
            rvec=camera.rvec.tolist(),
            tvec=camera.tvec.tolist(),
            distortion=camera.distortion.tolist(),
            model=camera.model.value,
        )
        for camera in cameras
    )


def add_frames(dataset: Dataset, numbers: Sequence[int], made: Mapping[Key, Derivatives]) -> None:
    """Frames with their images, one per camera of the dataset."""
    frames = Frame.objects.bulk_create(
        [Frame(dataset=dataset, number=number) for number in numbers], batch_size=ROWS_AT_ONCE
    )
    cameras = list(dataset.cameras.all())
    Image.objects.bulk_create(
        [
            Image(
                frame=frame,
                camera=camera,
                source_digest=picture.source_digest,
                light_digest=picture.light_digest,
                full_digest=picture.full_digest,
                light_bytes=picture.light_bytes,
                full_bytes=picture.full_bytes,
            )
            for frame in frames
            for camera in cameras
            for picture in [made[camera.index, frame.number]]
        ],
        batch_size=ROWS_AT_ONCE,
    )


def mend_images(dataset: Dataset, made: Mapping[Key, Derivatives]) -> None:
    """Derivatives that were made again. A newer encoder may give other bytes, so also another digest."""
    for (camera, number), picture in made.items():
        Image.objects.filter(frame__dataset=dataset, frame__number=number, camera__index=camera).update(
            light_digest=picture.light_digest,
            full_digest=picture.full_digest,
            light_bytes=picture.light_bytes,
            full_bytes=picture.full_bytes,
        )


def add_annotations(layer: Layer, imported: Iterable[ImportedFrame]) -> None:
    """Frames the layer does not have yet, each with its first save, done."""
    following = iter(imported)
    while together := list(islice(following, FRAMES_AT_ONCE)):
        with transaction.atomic():  # all who save wait for the end of it
            _add_annotations(layer, together)


def _add_annotations(layer: Layer, imported: Sequence[ImportedFrame]) -> None:
    numbers = [each.number for each in imported]
    people = [each.rows() for each in imported]
    calibration = in_place_id(layer.dataset_id)
    found = Frame.objects.filter(dataset=layer.dataset, number__in=numbers)
    frames = {frame.number: frame for frame in found}
    heads = LayerFrame.objects.bulk_create(
        [
            LayerFrame(layer=layer, frame=frames[each.number], revision=1, done=True, nobody=not len(each))
            for each in imported
        ],
        batch_size=ROWS_AT_ONCE,
    )
    Save.objects.bulk_create(
        [
            Save(
                layer_frame=head,
                revision=1,
                save_id=uuid.uuid4(),
                annotations=[row.as_dict() for row in rows],
                done=True,
                nobody=not rows,
                calibration_id=calibration,
            )
            for head, rows in zip(heads, people, strict=True)
        ],
        batch_size=ROWS_AT_ONCE,
    )
    # Django's `pk` is a property: asked once per person it would take as long as making the row.
    layer_id, frame_ids = layer.pk, [frames[each.number].pk for each in imported]
    insert(
        Annotation,
        ("layer_id", "frame_id", *FIELDS),
        (
            (layer_id, frame_id, *row.values())
            for frame_id, rows in zip(frame_ids, people, strict=True)
            for row in rows
        ),
    )
    largest = max((int(each.persons.max()) for each in imported if len(each)), default=0)
    Layer.with_unfinished.filter(pk=layer.pk, last_person__lt=largest).update(last_person=largest)
