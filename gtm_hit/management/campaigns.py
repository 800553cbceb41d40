"""Campaigns and qualifications as the command line names them."""

from __future__ import annotations

from django.core.management.base import CommandError

from gtm_hit.management.lookups import dataset_named
from gtm_hit.models import Campaign, Qualification, Worker


def campaign_named(slug: str, name: str) -> Campaign:
    dataset = dataset_named(slug)
    found = Campaign.objects.filter(dataset=dataset, name=name).select_related("dataset").first()
    if found is None:
        there = ", ".join(dataset.campaigns.values_list("name", flat=True)) or "none"
        raise CommandError(f"no campaign {name} in dataset {slug}; there are: {there}")
    return found


def qualification_named(slug: str, name: str) -> Qualification:
    dataset = dataset_named(slug)
    found = Qualification.objects.filter(dataset=dataset, name=name).select_related("truth").first()
    if found is None:
        there = ", ".join(dataset.qualifications.values_list("name", flat=True)) or "none"
        raise CommandError(f"no qualification {name} in dataset {slug}; there are: {there}")
    return found


def worker_named(pseudonym: str) -> Worker:
    found = Worker.objects.filter(pseudonym=pseudonym).first()
    if found is None:
        raise CommandError(f"no worker {pseudonym}")
    return found
