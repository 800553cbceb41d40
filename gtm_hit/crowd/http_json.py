"""JSON over HTTP(S) to one address, with a key; tells apart what can have happened from what cannot."""

from __future__ import annotations

import http.client
import json
import math
import ssl
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from email.message import Message
from email.utils import parsedate_to_datetime
from typing import Any
from urllib.parse import urlencode, urlsplit

from gtm_hit.ops.outbox.platform import NotSent, PlatformError, Refused, TooFast, Unanswered

MOST_BYTES = 8_000_000
MOST_WAIT = 3600.0  # seconds; whoever asks for more is asked again after this
QUOTED = 300


@dataclass(frozen=True)
class Retries:
    """For questions only; what changes something is repeated by the outbox, which keeps a record."""

    most: int = 4
    first: float = 0.5
    longest: float = 8.0  # seconds; a question that has to wait longer is given up

    def wait(self, attempt: int) -> float:
        return min(self.first * 2**attempt, self.longest)


@dataclass
class HttpJson:
    """`base`: scheme, host, port and perhaps a path; redirects are not followed, they would carry the key."""

    base: str
    authorization: str
    timeout: float = 20.0
    retries: Retries = field(default_factory=Retries)
    sleep: Callable[[float], None] = time.sleep

    def get(self, path: str, query: Mapping[str, str | int] | None = None) -> Any:
        asked = f"{path}?{urlencode(query)}" if query else path
        for attempt in range(self.retries.most):
            last = attempt == self.retries.most - 1
            try:
                return self._decoded(self._exchange("GET", asked, None)[0])
            except TooFast as error:
                if last or error.seconds > self.retries.longest:
                    raise
                self.sleep(error.seconds)
            except (NotSent, Unanswered):
                if last:
                    raise
                self.sleep(self.retries.wait(attempt))
        raise AssertionError("the last attempt raises")

    def post(self, path: str, body: Mapping[str, Any]) -> bytes:
        """Once. What came back, which may be nothing; `decoded` reads it."""
        return self._exchange("POST", path, json.dumps(body).encode())[0]

    def post_for_answer(self, path: str, body: Mapping[str, Any]) -> Any:
        return self._decoded(self.post(path, body))

    def post_for_header(self, path: str, body: Mapping[str, Any], header: str) -> tuple[Any, str]:
        """The answer, and one of its headers; empty when it has none."""
        content, headers = self._exchange("POST", path, json.dumps(body).encode())
        return self._decoded(content), headers.get(header) or ""

    def _decoded(self, content: bytes) -> Any:
        try:
            return json.loads(content)
        except ValueError:
            raise Unanswered("The platform answered something that is no JSON.") from None

    def _exchange(self, method: str, path: str, body: bytes | None) -> tuple[bytes, Message]:
        connection = self._connection()
        try:
            try:
                connection.connect()
            except (OSError, http.client.HTTPException) as error:
                raise NotSent(f"No connection to {self.base}: {error}") from error
            try:
                connection.request(
                    method, f"{urlsplit(self.base).path.rstrip('/')}/{path}", body, self._headers(body)
                )
                answer = connection.getresponse()
                content = answer.read(MOST_BYTES + 1)
            except (OSError, http.client.HTTPException) as error:
                raise Unanswered(f"{self.base} did not answer: {error!r}") from error
        finally:
            connection.close()
        return checked(answer, content), answer.headers

    def _connection(self) -> http.client.HTTPConnection:
        parts = urlsplit(self.base)
        if not parts.hostname:
            raise NotSent(f"{self.base!r} is no address")
        if parts.scheme == "https":
            context = ssl.create_default_context()
            return http.client.HTTPSConnection(
                parts.hostname, parts.port, timeout=self.timeout, context=context
            )
        return http.client.HTTPConnection(parts.hostname, parts.port, timeout=self.timeout)

    def _headers(self, body: bytes | None) -> dict[str, str]:
        sent = {"Authorization": self.authorization, "Accept": "application/json"}
        return sent if body is None else {**sent, "Content-Type": "application/json"}


def checked(answer: http.client.HTTPResponse, content: bytes) -> bytes:
    if answer.status == 429:
        raise TooFast(seconds_to_wait(answer.headers.get("Retry-After")))
    if answer.status >= 500 or answer.status == 408:
        raise Unanswered(f"The platform has a problem of its own ({answer.status}).")
    if not 200 <= answer.status < 300:
        raise Refused(answer.status, f"The platform refused ({answer.status}): {reason(content)}")
    if len(content) > MOST_BYTES:
        raise PlatformError("The platform's answer is larger than anything it should send.")
    return content


def seconds_to_wait(header: str | None, now: Callable[[], float] = time.time) -> float:
    """`Retry-After` in seconds or as a date; five seconds when it says nothing one understands."""
    try:
        seconds = float(header or "")
    except ValueError:
        try:
            seconds = parsedate_to_datetime(header or "").timestamp() - now()
        except (TypeError, ValueError):
            seconds = 5.0
    return 5.0 if math.isnan(seconds) else min(max(seconds, 0.0), MOST_WAIT)


def reason(content: bytes) -> str:
    """The platform's own words where they are where they should be, else the beginning of what it sent."""
    try:
        error = json.loads(content).get("error", {})
        words = error.get("detail") or error.get("title") or content.decode(errors="replace")
    except (ValueError, AttributeError):
        words = content.decode(errors="replace")
    text = words if isinstance(words, str) else json.dumps(words)
    return " ".join(text.split())[:QUOTED] or "no reason given"
