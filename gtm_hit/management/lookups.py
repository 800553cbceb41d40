"""Datasets and what is in them, as the command line names them.

Each raises CommandError, which tells what there is.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeVar

from django.core.management.base import CommandError
from django.db.models import Model, QuerySet

from gtm_hit.models import Campaign, Dataset, Layer, Qualification

Row = TypeVar("Row", bound=Model)


def dataset_named(slug: str) -> Dataset:
    found = Dataset.objects.filter(slug=slug).first()
    if found is None:
        raise CommandError(f"no dataset {slug}{_there(Dataset.objects.values_list('slug', flat=True))}")
    return found


def layer_named(slug: str, name: str) -> Layer:
    """With its dataset."""
    return _named("layer", Layer.objects.select_related("dataset"), slug, name)


def campaign_named(slug: str, name: str) -> Campaign:
    """With its dataset."""
    return _named("campaign", Campaign.objects.select_related("dataset"), slug, name)


def qualification_named(slug: str, name: str) -> Qualification:
    """With its truth."""
    return _named("qualification", Qualification.objects.select_related("truth"), slug, name)


def _named(kind: str, rows: QuerySet[Row], slug: str, name: str) -> Row:
    there = rows.filter(dataset=dataset_named(slug))
    found = there.filter(name=name).first()
    if found is None:
        names: Any = there.values_list("name", flat=True)
        raise CommandError(f"no {kind} {name} in dataset {slug}{_there(names)}")
    return found


def _there(names: Iterable[str]) -> str:
    return f"; there are: {', '.join(names) or 'none'}"
