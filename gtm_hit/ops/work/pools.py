"""Which batches somebody takes from: a campaign's, or those made for the dataset itself."""

from __future__ import annotations

from dataclasses import dataclass

from django.db.models import QuerySet

from gtm_hit.models import Assignment, Batch, Campaign, Dataset, Worker


@dataclass(frozen=True)
class Pool:
    """`submission`: the platform's id of one piece of work, which is one batch then."""

    dataset: Dataset
    campaign: Campaign | None = None
    submission: str = ""

    @property
    def batches_at_once(self) -> int:
        """A submission is one batch, whatever the campaign allows."""
        return self.campaign.batches_at_once if self.campaign and not self.submission else 1

    def batches(self) -> QuerySet[Batch]:
        return Batch.objects.filter(dataset=self.dataset, campaign=self.campaign)

    def all_of(self, worker: Worker) -> QuerySet[Assignment]:
        """Everything the worker ever had here, whichever submission it belonged to."""
        return Assignment.objects.filter(
            worker=worker, batch__dataset=self.dataset, batch__campaign=self.campaign
        )

    def mine(self, worker: Worker) -> QuerySet[Assignment]:
        """What the worker may open from this seat."""
        rows = self.all_of(worker)
        return rows.filter(submission=self.submission) if self.submission else rows


Place = Pool | Dataset


def pool_of(place: Place) -> Pool:
    return place if isinstance(place, Pool) else Pool(place)
