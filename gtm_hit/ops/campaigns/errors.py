from __future__ import annotations

from gtm_hit.ops.errors import OperationError


class CampaignError(OperationError, ValueError):
    """What a campaign cannot be made, changed to or do; says why, and which field it is about."""

    def __init__(self, message: str, field: str = "") -> None:
        super().__init__(message)
        self.field = field
