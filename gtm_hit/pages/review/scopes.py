"""A review's address: below a campaign, or below the dataset for all of its work."""

from __future__ import annotations

from django.http import Http404
from django.urls import reverse

from gtm_hit.models import Assignment, Campaign
from gtm_hit.ops.review import queue
from gtm_hit.pages.datasets.listing import dataset_or_404


def scope_or_404(slug: str, name: str | None) -> queue.Scope:
    dataset = dataset_or_404(slug)
    if name is None:
        return queue.Scope(dataset)
    campaign = Campaign.objects.select_related("dataset").filter(dataset=dataset, name=name).first()
    if campaign is None:
        raise Http404
    return queue.Scope(dataset, campaign)


def assignment_or_404(scope: queue.Scope, pk: int) -> Assignment:
    rows = queue.described(Assignment.objects.filter(scope.within(), pk=pk))
    found = rows.select_related("layer__dataset").first()
    if found is None:
        raise Http404
    return found


def address(scope: queue.Scope, page: str = "", pk: int | None = None) -> str:
    """Of the queue (`page` empty) or of an assignment's page: `desk`, `mend`, `mended`, `appeal`."""
    names = [scope.dataset.slug, *([scope.campaign.name] if scope.campaign else [])]
    view = "campaign-review" if scope.campaign else "dataset-review"
    return reverse(f"{view}-{page}" if page else view, args=[*names, *([pk] if pk is not None else [])])
