from __future__ import annotations

from gtm_hit.ops.errors import OperationError


class ProposalError(OperationError, ValueError):
    """What was asked for cannot be proposed; says why."""
