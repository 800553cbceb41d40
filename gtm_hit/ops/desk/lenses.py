"""Lenses that are known already: out of a file, or the one the dataset has in place."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from django.conf import settings
from django.contrib.auth.models import User

from gtm_hit.formats.calibration.cameras_json import load_taken
from gtm_hit.formats.calibration.wildtrack_xml import read_intrinsic
from gtm_hit.formats.files import write_bytes
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import CalibrationError, Camera, CameraModel
from gtm_hit.models import Desk, DeskCamera
from gtm_hit.ops.desk import edits
from gtm_hit.ops.desk.desks import lens_in_place
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.things import LENS, camera_of

MOST_BYTES = 10_000_000


def put(
    desk: Desk,
    camera: str,
    size: tuple[int, int],
    matrix: Any,
    distortion: Any,
    source: str,
    user: User | None = None,
) -> None:
    """Use a lens that is known. Raises DeskError for numbers that no lens has, or another size."""
    row = camera_of(desk, camera)
    try:
        checked = Camera(row.index, row.name, *size, matrix, np.zeros(3), np.zeros(3), distortion)
    except CalibrationError as error:
        raise DeskError(f"{error}.") from error
    refuse_size(row, size)
    lens = {
        "matrix": checked.matrix.tolist(),
        "distortion": checked.distortion.tolist(),
        "source": source[:200],
    }
    value = {"lens": lens, "report": {}, "size": list(size)}
    edits.edit(desk, edits.lens_page(camera), f"lens of {source}", [(LENS, [camera], value)], user)


def put_file(desk: Desk, camera: str, data: bytes, name: str, user: User | None = None) -> None:
    """The camera's lens in a cameras.json, or that of an intrinsic file in OpenCV's XML or YAML.

    Raises FormatError, DeskError.
    """
    row = camera_of(desk, camera)
    settings.UPLOADS_ROOT.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix=".lens-", dir=settings.UPLOADS_ROOT) as scratch:
        path = Path(scratch) / f"lens{Path(name).suffix.lower() or '.xml'}"
        write_bytes(path, data)
        try:
            size, matrix, distortion = _of_json(path, row) if path.suffix == ".json" else _of_xml(path, row)
        except FormatError as error:
            raise error.relative_to(Path(scratch)) from error
    put(desk, camera, size, matrix, distortion, name, user)


def put_in_place(desk: Desk, camera: str, user: User | None = None) -> None:
    """The lens that the desk's dataset has in place. Raises DeskError."""
    row = camera_of(desk, camera)
    known = desk.dataset.cameras.filter(name=camera).first() if desk.dataset else None
    lens = lens_in_place(known) if known else None
    if known is None or lens is None:
        raise DeskError("The dataset has no lens of a model that the desk knows.")
    refuse_size(row, (known.width, known.height))
    value = {"lens": lens, "report": {}, "size": [known.width, known.height]}
    edits.edit(desk, edits.lens_page(camera), "lens in place", [(LENS, [camera], value)], user)


def refuse_size(row: DeskCamera, size: tuple[int, int]) -> None:
    """A lens of pictures of another size than those the camera has."""
    known = bool(row.full_digest) or row.desk.dataset_id is not None or row.clicks.exists()
    if known and (row.width, row.height) != size:
        raise DeskError(
            f"The lens is for pictures of {size[0]}×{size[1]} pixels; those of {row.name} have "
            f"{row.width}×{row.height}."
        )


def _of_json(path: Path, row: DeskCamera) -> tuple[tuple[int, int], Any, Any]:
    cameras = load_taken(path)
    found = next((each for each in cameras if each.name == row.name), None)
    if found is None and len(cameras) == 1:
        found = cameras[0]
    if found is None:
        raise DeskError(f"None of the file's cameras is named {row.name}.")
    _refuse_model(found.model)
    return (found.width, found.height), found.matrix, found.distortion


def _of_xml(path: Path, row: DeskCamera) -> tuple[tuple[int, int], Any, Any]:
    found = read_intrinsic(path)
    _refuse_model(found.model)
    if not row.width:
        raise DeskError("Such a file does not say how large its pictures are: send a picture first.")
    return (row.width, row.height), found.matrix, found.distortion


def _refuse_model(model: CameraModel) -> None:
    if model is not CameraModel.PINHOLE:
        raise DeskError(f"The desk does not know the model {model.value} yet.")
