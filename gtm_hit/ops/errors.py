"""The root of everything an operation refuses, so that whoever calls one can catch just that."""

from __future__ import annotations


class OperationError(Exception):
    """An operation was not carried out; the message is for the person who asked for it."""
