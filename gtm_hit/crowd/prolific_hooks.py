"""Prolific's messages to us: who may have sent them, and what they say."""

from __future__ import annotations

import base64
import hashlib
import hmac
import json
from dataclasses import dataclass
from datetime import UTC, datetime

from gtm_hit.crowd.prolific_client import moment, status_word
from gtm_hit.ops.errors import OperationError

LONGEST = 200


class NotAMessage(OperationError):
    """Rightly signed or not, it cannot be understood."""


@dataclass(frozen=True)
class StatusChange:
    """`at`: when it happened at the platform, which may be long before it is delivered."""

    event: str
    kind: str
    subject: str
    participant: str
    status: str
    at: datetime


def signature(secret: str, timestamp: str, body: bytes) -> str:
    digest = hmac.new(secret.encode(), timestamp.encode() + body, hashlib.sha256).digest()
    return base64.b64encode(digest).decode()


def is_signed(secret: str, timestamp: str, body: bytes, given: str) -> bool:
    """Without a secret nothing is."""
    return bool(secret) and hmac.compare_digest(
        signature(secret, timestamp, body), given.encode("ascii", "replace").decode()
    )


def read(body: bytes, event: str, signed_at: str, happened_at: str) -> StatusChange:
    """Raises NotAMessage. A message without a name is named by its content: the same again is the same."""
    try:
        told = json.loads(body)
    except (ValueError, RecursionError):
        raise NotAMessage("The message is no JSON.") from None
    if not isinstance(told, dict):
        raise NotAMessage("The message is no JSON object.")
    kind, subject, status, participant = (
        word(told, name) for name in ("event_type", "resource_id", "status", "participant_id")
    )
    if not kind or not subject:
        raise NotAMessage("The message does not say what happened to what.")
    name = event[:LONGEST] if event else hashlib.sha256(signed_at.encode() + body).hexdigest()
    return StatusChange(
        name[:120],
        kind[:60],
        subject[:120],
        participant[:255],
        status_word(status)[:40],
        time_of(happened_at, signed_at),
    )


def word(told: dict[str, object], name: str) -> str:
    value = told.get(name)
    return value.replace("\x00", "") if isinstance(value, str) else ""


def time_of(*stamps: str) -> datetime:
    """The first of them that is one: seconds since 1970, or a date."""
    for stamp in stamps:
        try:
            return datetime.fromtimestamp(float(stamp), UTC)
        except (ValueError, OverflowError, OSError):
            found = moment(stamp)
            if found is not None:
                return found if found.tzinfo else found.replace(tzinfo=UTC)
    raise NotAMessage("The message has no time.")
