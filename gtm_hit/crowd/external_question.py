"""Panels that embed the page in a frame of theirs, and get a form posted at the end (ExternalQuestion)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

from django.conf import settings as server
from django.utils.translation import gettext as _

from gtm_hit.crowd.platform import Arrival, ArrivalError, Exit, FormPost, Framing, Outcome, Stay
from gtm_hit.ops.campaigns.platform_settings import ExternalQuestion as Settings
from gtm_hit.ops.campaigns.platform_settings import origin_of, secure

WORKER, SUBMISSION = "workerId", "assignmentId"  # parameters of the address
PREVIEW = "ASSIGNMENT_ID_NOT_AVAILABLE"  # the submission of somebody who only looks
SUBMIT = "/mturk/externalSubmit"
MAX_ADDRESS = 200
MAX_ID = 120


@dataclass(frozen=True)
class ExternalQuestion:
    """`assignmentId` is known to the worker and his panel alone: the seat is his who has it."""

    settings: Settings
    by_submission = True
    by_login = False

    def arrival(self, given: Mapping[str, str]) -> Arrival:
        submission, submit_to = given.get(SUBMISSION, ""), given.get("turkSubmitTo", "")
        if submission == PREVIEW:
            return Arrival(preview=True)
        worker = given.get(WORKER, "")
        if not worker or not submission or len(submission) > MAX_ID:
            raise ArrivalError(_("Open this page from the task on your panel; it tells us who you are."))
        if not self.takes_forms(submit_to):
            raise ArrivalError(_("Your panel wants the result sent to an address that is not allowed here."))
        return Arrival(worker, submission, submit_to)

    def takes_forms(self, address: str) -> bool:
        """Whoever wrote the address may be anybody, so only listed origins are sent something."""
        if len(address) > MAX_ADDRESS or not secure(address):
            return False
        parts = urlsplit(address)
        plain = not parts.query and not parts.fragment
        return plain and origin_of(address) in allowed(self.settings.submit_to)

    def leave(self, outcome: Outcome, code: str, arrival: Arrival) -> Exit:
        # Who did nothing hands nothing in: he returns the task on his panel's page.
        if outcome is not Outcome.COMPLETED or not self.takes_forms(arrival.submit_to):
            return Stay()
        fields = {SUBMISSION: arrival.submission, "code": code}
        return FormPost(arrival.submit_to.rstrip("/") + SUBMIT, fields)

    def entry_address(self, link: str) -> str:
        return link

    def framing(self) -> Framing | None:
        return Framing(allowed(self.settings.frame_ancestors), allowed(self.settings.submit_to))


def allowed(origins: tuple[str, ...]) -> tuple[str, ...]:
    """Those the server still allows: its list may have become shorter since the campaign was written."""
    return tuple(one for one in origins if one in server.EMBEDDING_ORIGINS)
