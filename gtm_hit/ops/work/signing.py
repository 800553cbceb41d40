"""Signed tokens: nothing in them is secret, nothing can be altered, and most of them end with their date."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

from django.core.signing import BadSignature, Signer, TimestampSigner

from gtm_hit.ops.errors import OperationError

SEPARATOR = "."


class BadToken(OperationError):
    """Not signed here, cut off in copying, too old, or revoked."""


def sign(kind: str, content: list[Any]) -> str:
    """Valid until what it names is revoked."""
    return Signer(salt=salt(kind), sep=SEPARATOR).sign_object(content)


def unsign(kind: str, token: str) -> list[Any]:
    try:
        return Signer(salt=salt(kind), sep=SEPARATOR).unsign_object(token)
    except (BadSignature, ValueError) as error:
        raise BadToken("not signed here") from error


def sign_dated(kind: str, content: list[Any]) -> str:
    return TimestampSigner(salt=salt(f"dated.{kind}"), sep=SEPARATOR).sign_object(content)


def unsign_dated(kind: str, token: str, days: int = 0) -> list[Any]:
    """`days`: how old it may be; 0: however old."""
    age = timedelta(days=days) if days else None
    try:
        return TimestampSigner(salt=salt(f"dated.{kind}"), sep=SEPARATOR).unsign_object(token, max_age=age)
    except (BadSignature, ValueError) as error:
        raise BadToken("not signed here, or too old") from error


def salt(kind: str) -> str:
    # One per kind: a token of one kind is never taken for another.
    return f"gtm_hit.{kind}"
