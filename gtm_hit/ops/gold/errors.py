from __future__ import annotations

from gtm_hit.ops.errors import OperationError


class GoldError(OperationError, ValueError):
    """Settings that make no gold frames or no faults; says why."""
