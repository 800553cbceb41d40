"""What goes wrong with detectors."""

from __future__ import annotations


class DetectorError(ValueError):
    """A detector that cannot be had, or whose answers cannot be used; the message says why."""
