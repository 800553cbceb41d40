"""One question to one address and its answer, with an end to both waiting and reading.

Redirects are not followed: pictures go where the operator said and nowhere else.
"""

from __future__ import annotations

import http.client
import json
import ssl
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any
from urllib.parse import SplitResult, urlsplit

from gtm_hit.vision.detectors.errors import DetectorError

CHUNK = 65536


@dataclass(frozen=True)
class Limits:
    seconds: float = 100.0  # for an answer, in all; a large model on a processor takes its time
    health: float = 5.0
    most: int = 8_000_000  # bytes of an answer

    def for_health(self) -> Limits:
        return replace(self, seconds=min(self.health, self.seconds))


@dataclass(frozen=True)
class Answer:
    status: int
    content: bytes


def exchange(
    method: str, address: str, body: Mapping[str, Any] | None, limits: Limits, path: str = ""
) -> Answer:
    """Raises DetectorError where nothing comes back in time, or too much. `path` replaces the address's."""
    parts = _parts(address)
    ends = time.monotonic() + limits.seconds
    connection = _connection(parts, limits.seconds)
    headers = {"Accept": "application/json", "Content-Type": "application/json"}
    content = None if body is None else json.dumps(body).encode()
    target = path or (parts.path or "/") + (f"?{parts.query}" if parts.query else "")
    try:
        connection.request(method, target, content, headers)
        answer = connection.getresponse()
        return Answer(answer.status, _read(connection, answer, ends, limits))
    except TimeoutError as error:
        raise _too_late(address, limits) from error
    except (OSError, http.client.HTTPException) as error:
        raise DetectorError(f"the detector at {address} does not answer: {error or repr(error)}") from error
    finally:
        connection.close()


def as_json(answer: Answer) -> Any:
    if answer.status != 200:
        said = " ".join(answer.content[:300].decode(errors="replace").split())
        raise DetectorError(f"the detector answers {answer.status}: {said}")
    try:
        return json.loads(answer.content)
    except (ValueError, RecursionError) as error:
        raise DetectorError("the detector answers something that is no JSON") from error


def _parts(address: str) -> SplitResult:
    try:
        parts = urlsplit(address)
        known = parts.scheme in ("http", "https") and parts.hostname and parts.port != 0
    except ValueError:
        known = False
    if not known:
        raise DetectorError(f"{address} is no address: http://… or https://… is")
    return parts


def _connection(parts: SplitResult, seconds: float) -> http.client.HTTPConnection:
    host = parts.hostname or ""
    if parts.scheme == "https":
        context = ssl.create_default_context()
        return http.client.HTTPSConnection(host, parts.port, timeout=seconds, context=context)
    return http.client.HTTPConnection(host, parts.port, timeout=seconds)


def _read(
    connection: http.client.HTTPConnection, answer: http.client.HTTPResponse, ends: float, limits: Limits
) -> bytes:
    """All of it, though it may come drop by drop."""
    content = bytearray()
    while True:
        left = ends - time.monotonic()
        if left <= 0:
            raise TimeoutError
        if connection.sock is not None:
            connection.sock.settimeout(left)
        part = answer.read1(CHUNK)
        if not part:
            return bytes(content)
        content += part
        if len(content) > limits.most:
            raise DetectorError(f"the detector answers more than {limits.most} bytes")


def _too_late(address: str, limits: Limits) -> DetectorError:
    return DetectorError(f"the detector at {address} does not answer within {limits.seconds:g} seconds")
