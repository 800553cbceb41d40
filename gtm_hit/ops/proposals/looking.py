"""The bridge from stored pictures to the room that looks for people."""

from __future__ import annotations

from typing import Any, Protocol

from gtm_hit.models import Dataset
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.proposing import Looker


class NamedLooker(Looker, Protocol):
    """What tells runs apart: the method that could be used, the detector, the settings."""

    method: str
    model: str
    settings: dict[str, Any]


def looker(dataset: Dataset, method: str, detector: str) -> NamedLooker:
    """Raises ProposalError where the detector cannot be had."""
    raise ProposalError(f"{dataset}: nothing here can look for people by {method} with {detector}")
