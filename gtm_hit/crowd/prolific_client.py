"""Prolific's REST interface, as far as campaigns need it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from decimal import Decimal
from typing import Any
from urllib.parse import quote

from gtm_hit.crowd.http_json import HttpJson
from gtm_hit.ops.outbox.platform import (
    Bonus,
    PlatformError,
    Refused,
    Study,
    StudyDraft,
    Unanswered,
    WorkAtPlatform,
    require_reason,
)

PAGE = 100
MOST_PAGES = 2000
ACTIONS = {"publish": "PUBLISH", "pause": "PAUSE", "resume": "START", "stop": "STOP"}


@dataclass(frozen=True)
class ProlificClient:
    http: HttpJson

    @classmethod
    def at(cls, base: str, token: str, **options: Any) -> ProlificClient:
        return cls(HttpJson(base, f"Token {token}", **options))

    def create_study(self, draft: StudyDraft) -> Study:
        """A draft: nobody sees it and nothing is paid for."""
        return study_of(self.http.post_for_answer("api/v1/studies/", study_body(draft)))

    def study(self, identifier: str) -> Study:
        return study_of(self.http.get(f"api/v1/studies/{quoted(identifier)}/"))

    def change_study(self, identifier: str, action: str) -> Study:
        """`publish`, `pause`, `resume` or `stop`."""
        path = f"api/v1/studies/{quoted(identifier)}/transition/"
        return study_of(self.http.post_for_answer(path, {"action": ACTIONS[action]}))

    def submissions(self, study: str) -> Iterator[WorkAtPlatform]:
        for page in range(1, MOST_PAGES):
            query: dict[str, str | int] = {"study": study, "page": page, "page_size": PAGE}
            found = listed(self.http.get("api/v1/submissions/", query))
            yield from (work_of(one) for one in found)
            if len(found) < PAGE:
                return

    def submission(self, submission: str) -> WorkAtPlatform:
        return work_of(self.http.get(f"api/v1/submissions/{quoted(submission)}/"))

    def approve(self, submission: str) -> None:
        self._transition(submission, {"action": "APPROVE"})

    def reject(self, submission: str, message: str, category: str) -> None:
        require_reason(message, category)
        body = {"action": "REJECT", "message": message, "rejection_category": category}
        self._transition(submission, body)

    def request_return(self, submission: str, reasons: list[str]) -> None:
        path = f"api/v1/submissions/{quoted(submission)}/request-return/"
        self.http.post(path, {"request_return_reasons": reasons})

    def set_up_bonuses(self, study: str, bonuses: list[Bonus]) -> str:
        body = {"study_id": study, "csv_bonuses": bonus_lines(bonuses)}
        answer = self.http.post_for_answer("api/v1/submissions/bonus-payments/", body)
        prepared = answer.get("id") if isinstance(answer, dict) else None
        if not isinstance(prepared, str) or not prepared:
            raise Unanswered("Prolific prepared a bonus and did not say under which number.")
        return prepared

    def pay_bonuses(self, prepared: str) -> None:
        """Not idempotent. Prolific pays within some minutes of its answer."""
        self.http.post(f"api/v1/bulk-bonus-payments/{quoted(prepared)}/pay/", {})

    def make_secret(self, workspace: str) -> str:
        """What it signs its messages with. A workspace has one: making another ends the one before."""
        answer = self.http.post_for_answer("api/v1/hooks/secrets/", {"workspace_id": workspace})
        secret = answer.get("value") if isinstance(answer, dict) else None
        if not isinstance(secret, str) or not secret:
            raise Unanswered("Prolific made a secret and did not tell it.")
        return secret

    def subscribe(self, workspace: str, event: str, target: str) -> None:
        """Have messages about an event sent to an address, and confirm that we want them."""
        body = {"workspace_id": workspace, "event_type": event, "target_url": target}
        place = "api/v1/hooks/subscriptions/"
        answer, secret = self.http.post_for_header(place, body, "X-Hook-Secret")
        if not isinstance(answer, dict) or not isinstance(answer.get("id"), str):
            raise Unanswered("Prolific did not say under which number it sends messages.")
        self.http.post(f"{place}{quoted(answer['id'])}/", {"secret": secret})

    def _transition(self, submission: str, body: Mapping[str, str]) -> None:
        self.http.post(f"api/v1/submissions/{quoted(submission)}/transition/", body)


def bonus_lines(bonuses: list[Bonus]) -> str:
    """Whole currency units with two digits: `30` would be thirty pounds, and so is `30.00`."""
    for bonus in bonuses:
        if bonus.amount <= 0 or set(bonus.to) & set(',\r\n"') or not bonus.to:
            raise Refused(400, f"{bonus.to!r} cannot be paid {bonus.amount}.")
    return "\n".join(f"{bonus.to},{bonus.amount:.2f}" for bonus in bonuses)


def study_body(draft: StudyDraft) -> dict[str, Any]:
    return {
        "name": draft.title,
        "description": draft.description,
        "external_study_url": draft.address,
        "prolific_id_option": "url_parameters",
        "completion_codes": [
            {
                "code": draft.completion_code,
                "code_type": "COMPLETED",
                "actions": [{"action": "MANUALLY_REVIEW"}],
            }
        ],
        "total_available_places": draft.places,
        "estimated_completion_time": draft.minutes,
        "reward": int(draft.reward * 100),
        "device_compatibility": ["desktop"],
        "peripheral_requirements": [],
    }


def study_of(answer: Any) -> Study:
    if not isinstance(answer, dict) or not isinstance(answer.get("id"), str):
        raise Unanswered("Prolific did not say which study it means.")
    places, taken = (answer.get(name) for name in ("total_available_places", "places_taken"))
    state = str(answer.get("status") or "")
    return Study(answer["id"], state, whole(places), whole(taken))


def work_of(answer: Any) -> WorkAtPlatform:
    if not isinstance(answer, dict) or not isinstance(answer.get("id"), str):
        raise PlatformError("Prolific's list of submissions has a line without a number.")
    participant = answer.get("participant_id") or answer.get("participant") or ""
    return WorkAtPlatform(
        submission=answer["id"],
        participant=str(participant),
        status=status_word(answer.get("status")),
        return_requested=bool(answer.get("return_requested")),
        bonuses=tuple(units(each) for each in answer.get("bonus_payments") or []),
        completed_at=moment(answer.get("completed_at")),
    )


def status_word(status: object) -> str:
    """`AWAITING REVIEW` and `AWAITING_REVIEW` are one; both are found in its answers."""
    return str(status or "").replace("_", " ").strip().upper()


def units(cents: object) -> Decimal:
    """Bonuses come back in pence or cents, as a number that may be a float."""
    return (Decimal(str(cents)) / 100).quantize(Decimal("0.01"))


def moment(text: object) -> datetime | None:
    try:
        return datetime.fromisoformat(text) if isinstance(text, str) else None
    except ValueError:
        return None


def listed(answer: Any) -> list[Any]:
    found = answer.get("results") if isinstance(answer, dict) else None
    if not isinstance(found, list):
        raise PlatformError("Prolific sent no list of submissions.")
    return found


def whole(value: object) -> int:
    return value if isinstance(value, int) else 0


def quoted(identifier: str) -> str:
    return quote(identifier, safe="")
