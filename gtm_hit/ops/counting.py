"""Counts beside rows, without a query for each of them."""

from __future__ import annotations

from typing import Any

from django.db.models import Count, IntegerField, QuerySet, Subquery
from django.db.models.functions import Coalesce


def correlated_count(related: QuerySet[Any], group: str, counted: str, *, distinct: bool = False) -> Coalesce:
    """A correlated count, so that counting two relations in one query multiplies nothing."""
    counts = (
        related.order_by().values(group).annotate(number=Count(counted, distinct=distinct)).values("number")
    )
    return Coalesce(Subquery(counts, output_field=IntegerField()), 0)
