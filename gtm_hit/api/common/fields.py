"""Kinds of values that requests of several nouns hold."""

from __future__ import annotations

from typing import Any

from django.utils.translation import gettext as _
from rest_framework import serializers

LARGEST = 2**31 - 2  # one more still fits PostgreSQL's integer


class StrictBooleanField(serializers.BooleanField):
    """JSON's own true and false: "off" and 0 are mistakes of the sender."""

    def to_internal_value(self, data: Any) -> bool:
        if not isinstance(data, bool):
            raise serializers.ValidationError(_("Must be true or false."))
        return data
