"""Which detector looks: ours, none, one that somebody wrote, or one at an address the operator listed."""

from __future__ import annotations

from pathlib import Path

from django.conf import settings

from gtm_hit.vision.boxes import Detector
from gtm_hit.vision.detectors import (
    DetectorError,
    Params,
    at_address,
    built_in,
    from_entry_point,
    from_file,
    from_module,
    installed,
)
from gtm_hit.vision.located import Locator

BUILT_IN = "built-in"
NONE = "none"
FILE = "file:"  # a path follows
MODULE = "module:"  # a name follows
PLUGIN = "plugin:"  # the name under which an installed package offers it follows


def addresses() -> list[str]:
    """Where pictures may be sent; empty: nothing leaves the server."""
    return list(settings.DETECTOR_ADDRESSES)


def choices() -> list[str]:
    """What pages and REST may ask for: what the operator installed or listed.

    Files and modules run whatever is in them, so only commands on the server can name them.
    """
    return [BUILT_IN, NONE, *(f"{PLUGIN}{name}" for name in installed()), *addresses()]


def find(name: str, params: Params | None = None) -> Detector | Locator | None:
    """None for none, and for the built-in one where it was never fetched. Raises DetectorError."""
    params = params or {}
    if name.startswith(FILE):
        return from_file(Path(name.removeprefix(FILE)), params)
    if name.startswith(MODULE):
        return from_module(name.removeprefix(MODULE), params)
    if name.startswith(PLUGIN):
        return from_entry_point(name.removeprefix(PLUGIN), params)
    if params:
        raise DetectorError(f"{name} takes no parameters")
    if name == NONE:
        return None
    if name == BUILT_IN:
        return built_in(settings.DATA_DIR)
    if name in addresses():
        return at_address(name)
    raise DetectorError(f"there is no detector {name}")
