"""Which detector looks: ours, none, one that somebody wrote, or one at an address the operator listed."""

from __future__ import annotations

from django.conf import settings

from gtm_hit.vision.boxes import Detector
from gtm_hit.vision.detectors import DetectorError, built_in

BUILT_IN = "built-in"
NONE = "none"
FILE = "file:"  # a path follows
MODULE = "module:"  # a name follows


def addresses() -> list[str]:
    """Where pictures may be sent; empty: nothing leaves the server."""
    return list(settings.DETECTOR_ADDRESSES)


def choices() -> list[str]:
    """What pages and REST may ask for; files and modules are for the command line of the server."""
    return [BUILT_IN, NONE, *addresses()]


def find(name: str) -> Detector | None:
    """None for none, and for the built-in one where it was never fetched. Raises DetectorError."""
    if name == NONE:
        return None
    if name == BUILT_IN:
        return built_in(settings.DATA_DIR)
    raise DetectorError(f"there is no detector {name}")
