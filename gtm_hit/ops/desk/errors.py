"""Why something cannot be done at a desk."""

from __future__ import annotations

from gtm_hit.ops.errors import OperationError


class DeskError(OperationError, ValueError):
    """What was asked for cannot be done; says why, and nothing was changed."""


class NotThere(DeskError):
    """The desk has no such camera, point or picture."""
