"""Prolific: three parameters in the study's address, and a code per outcome in the address back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlencode, urlsplit

from django.utils.translation import gettext as _

from gtm_hit.crowd.platform import Arrival, ArrivalError, Exit, Framing, Outcome, Redirect, Stay
from gtm_hit.ops.campaigns.platform_settings import Prolific as Settings
from gtm_hit.ops.outbox.studies import with_placeholders

MAX_ID = 120


@dataclass(frozen=True)
class Prolific:
    """SESSION_ID is the submission, known to the participant and Prolific alone."""

    settings: Settings
    by_submission = True
    by_login = False

    def arrival(self, given: Mapping[str, str]) -> Arrival:
        worker = given.get(self.settings.worker_parameter, "")
        submission = given.get(self.settings.submission_parameter, "")
        # A study that is looked at before it is published has its placeholders in the address.
        if "{{%" in worker + submission:
            return Arrival(preview=True)
        if not worker or not submission or len(submission) > MAX_ID:
            raise ArrivalError(_("Open this page from the study on Prolific; it tells us who you are."))
        return Arrival(worker, submission)

    def leave(self, outcome: Outcome, code: str, arrival: Arrival) -> Exit:
        codes = {
            Outcome.COMPLETED: self.settings.code_completed,
            Outcome.NO_WORK: self.settings.code_no_work,
            Outcome.NOT_ADMITTED: self.settings.code_not_admitted,
        }
        if not codes[outcome]:
            return Stay()
        address = self.settings.completion_address
        joined = "&" if urlsplit(address).query else "?"
        return Redirect(address + joined + urlencode({"cc": codes[outcome]}))

    def entry_address(self, link: str) -> str:
        return with_placeholders(self.settings, link)

    def framing(self) -> Framing | None:
        return None
