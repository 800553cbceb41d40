"""Datasets and what belongs to them as the command line names them."""

from __future__ import annotations

from collections.abc import Iterable

from django.core.management.base import CommandError

from gtm_hit.models import Campaign, Dataset, Layer, Qualification


def dataset_named(slug: str) -> Dataset:
    """Raises CommandError that tells which datasets there are."""
    found = Dataset.objects.filter(slug=slug).first()
    if found is None:
        raise CommandError(f"no dataset {slug}{_there(Dataset.objects.values_list('slug', flat=True))}")
    return found


def layer_named(slug: str, name: str) -> Layer:
    """With its dataset; raises CommandError that tells which datasets or layers there are."""
    dataset = dataset_named(slug)
    found = Layer.objects.select_related("dataset").filter(dataset=dataset, name=name).first()
    if found is None:
        names = Layer.objects.filter(dataset=dataset).values_list("name", flat=True)
        raise CommandError(f"no layer {name} in dataset {slug}{_there(names)}")
    return found


def campaign_named(slug: str, name: str) -> Campaign:
    """With its dataset; raises CommandError that tells which datasets or campaigns there are."""
    dataset = dataset_named(slug)
    found = Campaign.objects.select_related("dataset").filter(dataset=dataset, name=name).first()
    if found is None:
        names = dataset.campaigns.values_list("name", flat=True)
        raise CommandError(f"no campaign {name} of dataset {slug}{_there(names)}")
    return found


def qualification_named(slug: str, name: str) -> Qualification:
    """Raises CommandError that tells which datasets or qualifications there are."""
    dataset = dataset_named(slug)
    found = Qualification.objects.select_related("truth").filter(dataset=dataset, name=name).first()
    if found is None:
        names = dataset.qualifications.values_list("name", flat=True)
        raise CommandError(f"no qualification {name} of dataset {slug}{_there(names)}")
    return found


def _there(names: Iterable[str]) -> str:
    return f"; there are: {', '.join(names) or 'none'}"
