"""What bundle adjustment refuses."""

from __future__ import annotations


class AdjustmentError(ValueError):
    """A problem that has no answer to trust; the message says which camera or point, and what would help."""
