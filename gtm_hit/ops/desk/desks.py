"""Desks: made, listed, removed; and their cameras."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django.contrib.auth.models import User
from django.core.exceptions import ValidationError
from django.db import IntegrityError, transaction

from gtm_hit.geometry.camera import CameraModel
from gtm_hit.models import Camera, Dataset, Desk, DeskCamera, DeskPicture
from gtm_hit.models.dataset import name_validator
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.things import camera_named, camera_of

MOST_CAMERAS = 100
IN_PLACE = "the dataset's calibration in place"


def make(
    slug: str,
    title: str = "",
    dataset: Dataset | None = None,
    cameras: Sequence[str] = (),
    user: User | None = None,
) -> Desk:
    """A desk with the dataset's cameras, or with cameras so named.

    A dataset's begin with the lens that is in place and a picture of the first frame. Raises DeskError.
    """
    if dataset is not None and cameras:
        raise DeskError("The cameras are the dataset's: leave their names out.")
    try:
        with transaction.atomic():
            desk = Desk.objects.create(slug=slug, title=title or slug, dataset=dataset, created_by=user)
            if dataset is None:
                for name in cameras:
                    add_camera(desk, name)
            else:
                _take_cameras(desk, dataset)
    except IntegrityError as error:
        raise DeskError(f"There is a desk {slug} already.") from error
    return desk


def remove(desk: Desk) -> None:
    """With everything on it; what was put in place stays."""
    desk.delete()


def add_camera(desk: Desk, name: str) -> DeskCamera:
    """Behind those that are there. Raises DeskError."""
    if desk.dataset_id is not None and desk.cameras.exists():
        raise DeskError("The cameras are the dataset's: it gets no other ones.")
    _refuse_name(name)
    with transaction.atomic():
        Desk.objects.select_for_update().get(pk=desk.pk)
        count = desk.cameras.count()
        if count >= MOST_CAMERAS:
            raise DeskError(f"A desk has at most {MOST_CAMERAS} cameras.")
        if desk.cameras.filter(name=name).exists():
            raise DeskError(f"There is a camera {name} already.")
        return DeskCamera.objects.create(desk=desk, index=count, name=name)


def remove_camera(desk: Desk, name: str) -> None:
    """One that nothing was done for yet. Raises DeskError."""
    with transaction.atomic():
        Desk.objects.select_for_update().get(pk=desk.pk)
        camera = camera_of(desk, name)
        if desk.dataset_id is not None:
            raise DeskError("The cameras are the dataset's: none can be left out.")
        changes = (change for edit in desk.edits.all() for change in edit.changes)
        touched = any(camera_named(kind, key) == name for kind, key, *_rest in changes)
        if touched or camera.board_pictures.exists():
            raise DeskError(f"Work has been done for {name}; it stays.")
        camera.delete()
        for index, each in enumerate(desk.cameras.order_by("index")):
            DeskCamera.objects.filter(pk=each.pk).update(index=index)


def _take_cameras(desk: Desk, dataset: Dataset) -> None:
    frame = dataset.frames.first()
    pictures = {image.camera_id: image for image in frame.images.all()} if frame else {}
    for row in dataset.cameras.all():
        picture = pictures.get(row.pk)
        if picture:
            DeskPicture.objects.get_or_create(
                desk=desk, light_digest=picture.light_digest, full_digest=picture.full_digest
            )
        DeskCamera.objects.create(
            desk=desk,
            index=row.index,
            name=row.name,
            width=row.width,
            height=row.height,
            lens=lens_in_place(row),
            light_digest=picture.light_digest if picture else "",
            full_digest=picture.full_digest if picture else "",
        )


def lens_in_place(row: Camera) -> dict[str, Any] | None:
    """The lens of a dataset's camera; None for a model that the desk does not know."""
    if row.model != CameraModel.PINHOLE.value:
        return None
    return {"matrix": row.matrix, "distortion": row.distortion or [0.0] * 5, "source": IN_PLACE}


def _refuse_name(name: str) -> None:
    try:
        name_validator(name)
    except ValidationError as error:
        raise DeskError(f"{name}: {' '.join(error.messages)}") from error
    if len(name) > 80:
        raise DeskError("A camera's name has at most 80 letters.")
