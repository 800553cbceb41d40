"""Whose batches, and which layer they go into."""

from __future__ import annotations

from dataclasses import dataclass

from django.db import transaction
from django.db.models import QuerySet

from gtm_hit.models import Assignment, Campaign, Dataset, Layer, Stitching
from gtm_hit.ops.jobs.queue import JobError

NAME = "ground-truth"


class StitchingError(JobError):
    """What was asked for cannot be stitched or decided; says why."""


@dataclass(frozen=True)
class Scope:
    """A campaign's batches, or those of a dataset that belong to no campaign."""

    dataset: Dataset
    campaign: Campaign | None = None

    @property
    def layer_name(self) -> str:
        return f"{NAME}-{self.campaign.name}"[:120] if self.campaign else NAME

    def accepted(self) -> QuerySet[Assignment]:
        """What may become ground truth."""
        found = Assignment.objects.filter(
            batch__dataset=self.dataset, batch__campaign=self.campaign, state=Assignment.State.ACCEPTED
        )
        return found.select_related("batch", "worker", "mend").order_by("batch__number", "layer_id")

    def stitching(self) -> Stitching | None:
        found = Stitching.objects.filter(dataset=self.dataset, campaign=self.campaign)
        return found.select_related("dataset", "campaign", "layer").first()


def named(dataset: Dataset, campaign: str = "") -> Scope:
    """Raises StitchingError for a campaign the dataset does not have."""
    if not campaign:
        return Scope(dataset)
    found = Campaign.objects.filter(dataset=dataset, name=campaign).first()
    if found is None:
        raise StitchingError(f"There is no campaign {campaign}.")
    return Scope(dataset, found)


def opened(scope: Scope) -> Stitching:
    """The scope's stitching, made with its empty layer the first time."""
    with transaction.atomic():
        Dataset.objects.select_for_update(no_key=True).get(pk=scope.dataset.pk)
        if found := scope.stitching():
            return found
        if Layer.with_unfinished.filter(dataset=scope.dataset, name=scope.layer_name).exists():
            reason = "but stitching did not make it. Give it another name first."
            raise StitchingError(f"There is a layer {scope.layer_name} already, {reason}")
        layer = Layer.objects.create(
            dataset=scope.dataset, name=scope.layer_name, kind=Layer.Kind.GROUND_TRUTH
        )
        return Stitching.objects.create(dataset=scope.dataset, campaign=scope.campaign, layer=layer)
