"""A desk's pictures: those of the ground, and who may see which file."""

from __future__ import annotations

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import Q

from gtm_hit.models import BoardPicture, Desk, DeskCamera, DeskPicture, Image
from gtm_hit.ops.desk import edits
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.things import PICTURE, camera_of
from gtm_hit.ops.files.images import ImageError, decode, make_derivatives
from gtm_hit.ops.files.picture_cleanup import pictures_in_use

MOST_BYTES = 50_000_000


def put(desk: Desk, camera: str, data: bytes, user: User | None = None) -> None:
    """Make an uploaded picture the camera's picture of the ground. Raises DeskError."""
    row = camera_of(desk, camera)
    if len(data) > MOST_BYTES:
        raise DeskError(f"The picture is larger than {MOST_BYTES // 1_000_000} MB.")
    with pictures_in_use():
        try:
            width, height = decode(data).size
            _refuse_size(row, width, height)
            made = make_derivatives(data)
        except ImageError as error:
            raise DeskError(f"The picture cannot be used: {error}.") from error
        value = [made.light_digest, made.full_digest, width, height]
        with transaction.atomic():
            remember(desk, made.light_digest, made.full_digest)
            edits.edit(desk, edits.GROUND, f"picture of {camera}", [(PICTURE, [camera], value)], user)


def put_frame(desk: Desk, camera: str, number: int, user: User | None = None) -> None:
    """Take the picture of one of the dataset's frames. Raises DeskError."""
    row = camera_of(desk, camera)
    if desk.dataset is None:
        raise DeskError("The desk has no dataset to take a picture from.")
    found = Image.objects.filter(
        frame__dataset=desk.dataset, frame__number=number, camera__name=camera
    ).first()
    if found is None:
        raise DeskError(f"The dataset has no frame {number}.")
    value = [found.light_digest, found.full_digest, row.width, row.height]
    with transaction.atomic():
        remember(desk, found.light_digest, found.full_digest)
        edits.edit(desk, edits.GROUND, f"frame {number} for {camera}", [(PICTURE, [camera], value)], user)


def remember(desk: Desk, light: str, full: str) -> None:
    DeskPicture.objects.get_or_create(desk=desk, light_digest=light, full_digest=full)


def shows(desk: Desk, digest: str) -> bool:
    """Whether a picture of this desk, now or before an undoing, has this file."""
    either = Q(light_digest=digest) | Q(full_digest=digest)
    return (
        DeskPicture.objects.filter(either, desk=desk).exists()
        or BoardPicture.objects.filter(either, camera__desk=desk).exists()
    )


def _refuse_size(camera: DeskCamera, width: int, height: int) -> None:
    known = camera.width and (camera.lens is not None or camera.desk.dataset_id or camera.clicks.exists())
    if known and (camera.width, camera.height) != (width, height):
        raise DeskError(
            f"The picture has {width}×{height} pixels; {camera.name} has {camera.width}×{camera.height}."
        )
