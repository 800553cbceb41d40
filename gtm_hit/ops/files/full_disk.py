"""Telling a full disk from a busy server: waiting does not help then."""

from __future__ import annotations

import errno

from django.db import DatabaseError

FULL = {errno.ENOSPC, errno.EDQUOT}
# SQLite, PostgreSQL.
WORDS = ("database or disk is full", "no space left on device", "disk quota exceeded")


def disk_full(error: BaseException | None) -> bool:
    """Whether this, or what led to it, is for want of space."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in FULL:
            return True
        if isinstance(error, DatabaseError) and any(words in str(error).lower() for words in WORDS):
            return True
        error = error.__cause__ or error.__context__
    return False
