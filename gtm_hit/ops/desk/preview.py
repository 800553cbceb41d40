"""A desk's pictures with the lens taken out, to look at; and boards on paper."""

from __future__ import annotations

import cv2
import numpy as np
from django.core.files.storage import default_storage

from gtm_hit.calibration.boards import Board
from gtm_hit.calibration.pdf import board_pdf
from gtm_hit.calibration.printing import board_svg
from gtm_hit.geometry.camera import CalibrationError, undistort_maps
from gtm_hit.geometry.undistorting import kept_matrix
from gtm_hit.models import Desk
from gtm_hit.ops.desk import poses
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.ops.desk.things import camera_of
from gtm_hit.ops.files.images import storage_name

WIDTH = 1280  # pixels; it is looked at, not measured
SHEETS = {"svg": "image/svg+xml", "pdf": "application/pdf"}


def undistorted(desk: Desk, camera: str, digest: str = "") -> bytes:
    """A JPEG of a picture as a camera without a lens would have taken it, by default of the ground.

    Raises DeskError.
    """
    row = camera_of(desk, camera)
    lens = poses.lens_of(row)
    if lens is None:
        raise DeskError(poses.NO_LENS)
    known = row.board_pictures.filter(full_digest=digest).exists() if digest else bool(row.full_digest)
    if not known:
        raise NotThere(f"{camera} has no such picture.")
    view = lens.camera(row.name, np.zeros(3), np.zeros(3))
    try:
        maps = undistort_maps(view, kept_matrix(view, 1.0))
    except CalibrationError as error:
        raise DeskError(f"{error}.") from error
    straight = cv2.remap(_pixels(digest or row.full_digest), *maps, cv2.INTER_LINEAR)
    scale = min(1.0, WIDTH / lens.width)
    small = cv2.resize(straight, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, 88])[1].tobytes()


def sheet(board: Board, kind: str) -> bytes:
    """The board on paper in its true size, as svg or pdf."""
    return board_pdf(board) if kind == "pdf" else board_svg(board).encode()


def _pixels(digest: str) -> np.ndarray:
    try:
        with default_storage.open(storage_name(digest)) as stream:
            data = np.frombuffer(stream.read(), np.uint8)
    except FileNotFoundError as error:
        raise DeskError("The picture's file is gone.") from error
    pixels = cv2.imdecode(data, cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)
    if pixels is None:
        raise DeskError("The picture's file is damaged.")
    return pixels
