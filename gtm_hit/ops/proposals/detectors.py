"""Which detector looks: ours, none, or one at an address the operator listed."""

from __future__ import annotations

from django.conf import settings

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
