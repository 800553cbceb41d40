"""From a campaign to its platform."""

from __future__ import annotations

from gtm_hit.crowd.prolific_client import ProlificClient
from gtm_hit.models import Campaign
from gtm_hit.ops.outbox import accounts


def connect(campaign: Campaign) -> ProlificClient:
    """Raises AccountError without a key, or for an address this server may not ask."""
    account = accounts.of(campaign)
    return ProlificClient.at(accounts.address(account), accounts.key(account))
