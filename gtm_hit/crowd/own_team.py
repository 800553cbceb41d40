"""Accounts with a login: the worker is whoever has logged in, and no code is needed."""

from __future__ import annotations

from collections.abc import Mapping

from gtm_hit.crowd.platform import Arrival, Exit, Framing, Outcome, Stay


class OwnTeam:
    by_submission = False
    by_login = True

    def arrival(self, given: Mapping[str, str]) -> Arrival:
        return Arrival()

    def leave(self, outcome: Outcome, code: str, arrival: Arrival) -> Exit:
        return Stay()

    def entry_address(self, link: str) -> str:
        return link

    def framing(self) -> Framing | None:
        return None
