"""Any panel that sends people to an address and asks them for a code afterwards."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from gtm_hit.crowd.platform import Arrival, Exit, Framing, Outcome, ShowCode, Stay
from gtm_hit.ops.campaigns.platform_settings import SurveyLink as Settings

TYPED = "worker_id"  # the field of our own form


@dataclass(frozen=True)
class SurveyLink:
    """The panel may name the worker in the address; otherwise he types his id."""

    settings: Settings
    by_submission = False
    by_login = False

    def arrival(self, given: Mapping[str, str]) -> Arrival:
        return Arrival(given.get(TYPED, "") or given.get(self.settings.worker_parameter, ""))

    def leave(self, outcome: Outcome, code: str, arrival: Arrival) -> Exit:
        if outcome is not Outcome.COMPLETED:
            return Stay()
        return ShowCode(self.settings.fixed_code or code, self.settings.return_address)

    def entry_address(self, link: str) -> str:
        return link

    def framing(self) -> Framing | None:
        return None
