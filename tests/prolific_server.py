"""A stand-in for Prolific, over real HTTP, after its documentation and with its odd sides.

Paying a bonus twice pays twice. What it is told to do wrong (`go_wrong`) it does once per request, in order.
"""

from __future__ import annotations

import json
import re
import threading
import urllib.request
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from decimal import Decimal
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlsplit

from gtm_hit.crowd.prolific_hooks import signature

TOKEN = "prolific-test-key"
FINAL = {"APPROVED", "REJECTED", "RETURNED"}
NEEDED = [
    *("name", "description", "external_study_url", "prolific_id_option", "completion_codes"),
    *("total_available_places", "estimated_completion_time", "reward"),
]
STATES = {"PUBLISH": "ACTIVE", "START": "ACTIVE", "PAUSE": "PAUSED", "STOP": "AWAITING REVIEW"}


@dataclass
class Wrong:
    """`how`: drop_before, drop_after, hold (process, then answer never), status (answer it, do nothing),
    status_after (do it, answer this)."""

    path: str
    how: str
    status: int = 500
    retry_after: str = ""
    method: str = "POST"


@dataclass
class Prolific:
    studies: dict[str, dict[str, Any]] = field(default_factory=dict)
    submissions: dict[str, dict[str, Any]] = field(default_factory=dict)
    prepared: dict[str, list[tuple[str, int]]] = field(default_factory=dict)
    asked: list[str] = field(default_factory=list)
    wrongs: list[Wrong] = field(default_factory=list)
    payments: list[tuple[str, int]] = field(default_factory=list)
    secrets: list[str] = field(default_factory=list)
    subscriptions: dict[str, dict[str, Any]] = field(default_factory=dict)
    slow: bool = False  # bonuses are booked only by `book`
    base: str = ""
    lock: threading.RLock = field(default_factory=threading.RLock)
    holding: threading.Event = field(default_factory=threading.Event)
    let_go: threading.Event = field(default_factory=threading.Event)

    def add(
        self, submission: str, participant: str = "", status: str = "AWAITING REVIEW", study: str = "st1"
    ) -> None:
        self.submissions[submission] = {
            "id": submission,
            "participant_id": participant or f"p-{submission}",
            "study_id": study,
            "status": status,
            "bonus_payments": [],
            "return_requested": None,
            "completed_at": "2026-11-25T10:00:00Z",
            "message": None,
        }

    def go_wrong(self, path: str, how: str, **values: Any) -> None:
        self.wrongs.append(Wrong(path, how, **values))

    def paid(self, submission: str) -> Decimal:
        return Decimal(sum(cents for to, cents in self.payments if to == submission)) / 100

    def count(self, asked: str) -> int:
        return sum(1 for each in self.asked if each == asked)

    def book(self) -> None:
        with self.lock:
            for one in self.submissions.values():
                one["bonus_payments"] = [cents for to, cents in self.payments if to == one["id"]]

    # what it answers: status and body

    def answer(self, method: str, path: str, query: dict[str, list[str]], body: Any) -> tuple[int, Any]:
        for pattern, handler in (
            (r"GET /api/v1/submissions/", self.list_submissions),
            (r"GET /api/v1/submissions/([^/]+)/", self.one_submission),
            (r"POST /api/v1/submissions/bonus-payments/", self.set_up),
            (r"POST /api/v1/submissions/([^/]+)/transition/", self.transition),
            (r"POST /api/v1/submissions/([^/]+)/request-return/", self.request_return),
            (r"POST /api/v1/bulk-bonus-payments/([^/]+)/pay/", self.pay),
            (r"POST /api/v1/hooks/secrets/", self.make_secret),
            (r"POST /api/v1/hooks/subscriptions/", self.subscribe),
            (r"POST /api/v1/hooks/subscriptions/([^/]+)/", self.confirm_subscription),
            (r"POST /api/v1/studies/", self.create_study),
            (r"GET /api/v1/studies/([^/]+)/", self.one_study),
            (r"POST /api/v1/studies/([^/]+)/transition/", self.change_study),
        ):
            if found := re.fullmatch(pattern, f"{method} {path}"):
                with self.lock:
                    return handler(*found.groups(), query=query, body=body)
        return refusal(404, "Not found")

    def list_submissions(self, query: dict[str, list[str]], body: Any) -> tuple[int, Any]:
        if "study" not in query:
            return refusal(400, "study is required")
        page, size = int(query.get("page", ["1"])[0]), int(query.get("page_size", ["20"])[0])
        found = [one for one in self.submissions.values() if one["study_id"] == query["study"][0]]
        return 200, {"results": found[(page - 1) * size : page * size], "meta": {"count": len(found)}}

    def one_submission(self, pk: str, query: Any, body: Any) -> tuple[int, Any]:
        return (200, self.submissions[pk]) if pk in self.submissions else refusal(404, "No such submission")

    def transition(self, pk: str, query: Any, body: Any) -> tuple[int, Any]:
        one, action = self.submissions.get(pk), body.get("action")
        if one is None:
            return refusal(404, "No such submission")
        wanted = {"APPROVE": "APPROVED", "REJECT": "REJECTED"}.get(action)
        if wanted is None:
            return refusal(400, "Unknown action")
        if one["status"] == wanted:
            return 200, one  # the same again is ignored
        if one["status"] in FINAL or one["status"] != "AWAITING REVIEW":
            return refusal(400, f"A submission that is {one['status']} cannot become {wanted}")
        if action == "REJECT" and (
            len(body.get("message") or "") < 100 or not body.get("rejection_category")
        ):
            return refusal(400, {"message": ["Ensure this field has at least 100 characters."]})
        one |= {"status": wanted, "message": body.get("message")}
        return 200, one

    def request_return(self, pk: str, query: Any, body: Any) -> tuple[int, Any]:
        if pk not in self.submissions or not body.get("request_return_reasons"):
            return refusal(400, "reasons are required")
        self.submissions[pk]["return_requested"] = "2026-11-25T10:00:00Z"
        return 200, self.submissions[pk]

    def set_up(self, query: Any, body: Any) -> tuple[int, Any]:
        lines, unknown = [], []
        for line in body["csv_bonuses"].splitlines():
            to, amount = line.split(",")
            found = [
                one["id"] for one in self.submissions.values() if to in (one["id"], one["participant_id"])
            ]
            lines.append((found[0] if found else to, int(Decimal(amount) * 100)))
            unknown += [] if found else [to]
        if unknown or body["study_id"] not in self.studies:
            return refusal(400, f"These did not take part: {unknown}")
        pk = uuid.uuid4().hex[:24]
        self.prepared[pk] = lines
        amount = sum(cents for _to, cents in lines)
        return 200, {"id": pk, "study": body["study_id"], "amount": amount, "total_amount": amount * 1.33}

    def pay(self, pk: str, query: Any, body: Any) -> tuple[int, Any]:
        if pk not in self.prepared:
            return refusal(404, "No such bonus")
        self.payments += self.prepared[pk]
        if not self.slow:
            self.book()
        return 202, "Payment is being processed"

    def make_secret(self, query: Any, body: Any) -> tuple[int, Any]:
        self.secrets.append(uuid.uuid4().hex)
        return 201, {"id": "1", "value": self.secrets[-1], "workspace_id": body["workspace_id"]}

    def subscribe(self, query: Any, body: Any) -> tuple[int, Any]:
        if not body["target_url"].startswith("https://"):
            return refusal(400, "target_url must use https")
        pk = uuid.uuid4().hex[:24]
        self.subscriptions[pk] = {**body, "id": pk, "is_enabled": False, "confirm": uuid.uuid4().hex}
        return 201, {"id": pk, "is_enabled": False, "X-Hook-Secret": self.subscriptions[pk]["confirm"]}

    def confirm_subscription(self, pk: str, query: Any, body: Any) -> tuple[int, Any]:
        if pk not in self.subscriptions or body.get("secret") != self.subscriptions[pk]["confirm"]:
            return refusal(400, "The secret is wrong")
        self.subscriptions[pk]["is_enabled"] = True
        return 200, {"id": pk, "is_enabled": True}

    def create_study(self, query: Any, body: Any) -> tuple[int, Any]:
        if missing := [name for name in NEEDED if not body.get(name)]:
            return refusal(400, {name: ["This field is required."] for name in missing})
        pk = uuid.uuid4().hex[:24]
        self.studies[pk] = {**body, "id": pk, "status": "UNPUBLISHED", "places_taken": 0}
        return 201, self.studies[pk]

    def one_study(self, pk: str, query: Any, body: Any) -> tuple[int, Any]:
        return (200, self.studies[pk]) if pk in self.studies else refusal(404, "No such study")

    def change_study(self, pk: str, query: Any, body: Any) -> tuple[int, Any]:
        if pk not in self.studies or body.get("action") not in STATES:
            return refusal(400, "Unknown study or action")
        if body["action"] == "PUBLISH" and self.studies[pk]["status"] != "UNPUBLISHED":
            return refusal(400, "The study is published already")
        self.studies[pk]["status"] = STATES[body["action"]]
        return 200, self.studies[pk]


def refusal(status: int, detail: Any) -> tuple[int, Any]:
    return status, {"error": {"status": status, "error_code": 140000, "title": "Error", "detail": detail}}


class Handler(BaseHTTPRequestHandler):
    prolific: Prolific
    protocol_version = "HTTP/1.1"

    def log_message(self, format: str, *args: Any) -> None:
        pass

    def do_GET(self) -> None:
        self.respond()

    def do_POST(self) -> None:
        self.respond()

    def respond(self) -> None:
        parts = urlsplit(self.path)
        content = self.rfile.read(int(self.headers.get("Content-Length") or 0))
        self.prolific.asked.append(f"{self.command} {parts.path}")
        if self.headers.get("Authorization") != f"Token {TOKEN}":
            return self.send(401, refusal(401, "Authentication credentials were not provided.")[1])
        wrong = self.wrong(parts.path)
        if wrong and wrong.how == "drop_before":
            return self.drop()
        if wrong and wrong.how == "status":
            return self.send(wrong.status, {"error": {"detail": "Something is wrong"}}, wrong.retry_after)
        body = json.loads(content) if content else {}
        status, answer = self.prolific.answer(self.command, parts.path, parse_qs(parts.query), body)
        if wrong and wrong.how == "hold":
            self.prolific.holding.set()
            self.prolific.let_go.wait(120)
        if wrong and wrong.how in {"drop_after", "hold"}:
            return self.drop()
        self.send(wrong.status if wrong else status, answer)

    def wrong(self, path: str) -> Wrong | None:
        with self.prolific.lock:
            for each in self.prolific.wrongs:
                if each.path in path and each.method == self.command:
                    self.prolific.wrongs.remove(each)
                    return each
        return None

    def drop(self) -> None:
        self.close_connection = True
        with suppress(OSError):
            self.connection.shutdown(2)

    def send(self, status: int, answer: Any, retry_after: str = "") -> None:
        hook = answer.pop("X-Hook-Secret", "") if isinstance(answer, dict) else ""
        content = json.dumps(answer).encode()
        with suppress(OSError):
            self.send_response(status)
            self.send_header("Content-Type", "application/json")
            self.send_header("Content-Length", str(len(content)))
            if hook:
                self.send_header("X-Hook-Secret", hook)
            if retry_after:
                self.send_header("Retry-After", retry_after)
            self.end_headers()
            self.wfile.write(content)


@contextmanager
def prolific_server() -> Iterator[Prolific]:
    prolific = Prolific()
    prolific.studies["st1"] = {
        "id": "st1",
        "status": "ACTIVE",
        "total_available_places": 10,
        "places_taken": 2,
    }
    server = ThreadingHTTPServer(("127.0.0.1", 0), type("Bound", (Handler,), {"prolific": prolific}))
    server.daemon_threads = True
    prolific.base = f"http://127.0.0.1:{server.server_port}"
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield prolific
    finally:
        prolific.let_go.set()
        server.shutdown()
        server.server_close()


def hook_headers(secret: str, body: bytes, at: float, event: str = "") -> dict[str, str]:
    """As it signs its messages; `at`: seconds since 1970."""
    return {
        "X-Prolific-Request-Timestamp": str(at),
        "X-Prolific-Request-Signature": signature(secret, str(at), body),
        "X-Event-ID": event or uuid.uuid4().hex,
        "Content-Type": "application/json",
    }


def hook_body(submission: str, status: str, participant: str = "p1") -> bytes:
    told = {
        "event_type": "submission.status.change",
        "resource_id": submission,
        "participant_id": participant,
        "study_id": "st1",
        "status": status,
    }
    return json.dumps(told).encode()


def deliver(address: str, body: bytes, headers: dict[str, str]) -> int:
    request = urllib.request.Request(address, body, headers, method="POST")
    with urllib.request.urlopen(request, timeout=20) as answer:
        return int(answer.status)
