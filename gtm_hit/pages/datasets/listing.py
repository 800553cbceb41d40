from __future__ import annotations

from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import render
from django.urls import path
from django.utils.translation import gettext as _
from django.views.decorators.cache import cache_control
from django.views.decorators.http import require_safe

from gtm_hit.models import Dataset
from gtm_hit.ops import overview
from gtm_hit.ops.access.roles import SEES, Somebody
from gtm_hit.ops.ground import coverage
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.datasets.ground_map import GroundMap


def summary_or_404(slug: str, user: Somebody) -> overview.DatasetSummary:
    summary = overview.dataset(slug, user)
    if summary is None:
        raise Http404(_("There is no dataset “%(slug)s”.") % {"slug": slug})
    return summary


def dataset_or_404(slug: str) -> Dataset:
    """For pages that count nothing."""
    found = Dataset.objects.filter(slug=slug).first()
    if found is None:
        raise Http404(_("There is no dataset “%(slug)s”.") % {"slug": slug})
    return found


@require_safe
@needs(SEES)
def datasets(request: HttpRequest) -> HttpResponse:
    context = {"section": "datasets", "summaries": overview.datasets(request.user)}
    return render(request, "staff/datasets.html", context)


@require_safe
@needs(SEES)
def dataset(request: HttpRequest, slug: str) -> HttpResponse:
    summary = summary_or_404(slug, request.user)
    seen = coverage.coverage(summary.dataset) if summary.cameras else None
    context = {
        "section": "datasets",
        "tab": "dataset",
        "dataset": summary.dataset,
        "summary": summary,
        "coverage": seen,
        "map": GroundMap(summary.dataset, seen) if seen else None,
    }
    return render(request, "staff/dataset.html", context)


@require_safe
@needs(SEES)
@cache_control(private=True, max_age=31536000, immutable=True)
def coverage_picture(request: HttpRequest, slug: str, digest: str) -> HttpResponse:
    """The address carries the digest of everything the picture is made from, so it never changes."""
    seen = coverage.coverage(dataset_or_404(slug))
    if seen.digest != digest:
        raise Http404(_("The dataset's cameras or grid have changed."))
    return HttpResponse(seen.picture, content_type="image/png")


urlpatterns = [
    path("datasets/", datasets, name="datasets"),
    path("datasets/<slug:slug>/", dataset, name="dataset"),
    path("datasets/<slug:slug>/coverage/<str:digest>.png", coverage_picture, name="coverage-picture"),
]
