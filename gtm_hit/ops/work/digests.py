"""Keyed digests of what the database need not know in clear: addresses, names, browsers' secrets."""

from __future__ import annotations

from django.utils.crypto import salted_hmac


def digest(*parts: str) -> str:
    # Joined by what is in none of them, so that no two lists of parts make one text.
    return salted_hmac("gtm_hit.digest", "\x00".join(parts), algorithm="sha256").hexdigest()
