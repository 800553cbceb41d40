"""Clicks of measured points in the pictures of the ground."""

from __future__ import annotations

import math

from django.contrib.auth.models import User

from gtm_hit.models import Desk, DeskEdit
from gtm_hit.ops.desk import edits
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.things import CLICK, camera_of, point_of


def put(desk: Desk, camera: str, point: str, x: float, y: float, user: User | None = None) -> DeskEdit | None:
    """Say where a point is seen; None where that was said before. Raises DeskError."""
    row = camera_of(desk, camera)
    point_of(desk, point)
    if not row.width:
        raise DeskError(f"{camera} has no picture yet.")
    if not (math.isfinite(x) and math.isfinite(y)):
        raise DeskError("A click is two finite numbers.")
    if not (-0.5 <= x <= row.width - 0.5 and -0.5 <= y <= row.height - 0.5):
        raise DeskError(
            f"{x:.1f}, {y:.1f} is outside the picture of {camera}, which has {row.width}×{row.height} pixels."
        )
    return edits.edit(desk, edits.GROUND, f"{point} in {camera}", [(CLICK, [camera, point], [x, y])], user)


def remove(desk: Desk, camera: str, point: str, user: User | None = None) -> DeskEdit | None:
    """Raises NotThere for a camera or point that the desk does not have."""
    camera_of(desk, camera)
    point_of(desk, point)
    what = f"{point} in {camera} removed"
    return edits.edit(desk, edits.GROUND, what, [(CLICK, [camera, point], None)], user)
