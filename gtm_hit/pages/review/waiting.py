"""The queue: what waits, most suspicious first, what was returned, appeals, and what was decided."""

from __future__ import annotations

from typing import Any

from django.core.paginator import Paginator
from django.http import HttpRequest, HttpResponse
from django.shortcuts import render
from django.urls import path
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_safe

from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.review import queue
from gtm_hit.ops.review.actors import own_work
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.review.scopes import address, scope_or_404

ROWS_PER_PAGE = 50
LISTS = {
    "waiting": queue.waiting,
    "appeals": queue.open_appeals,
    "returned": queue.returned,
    "decided": queue.decided,
}


@require_safe
@never_cache
@needs(Role.REVIEWER)
def waiting(request: HttpRequest, slug: str, name: str | None = None) -> HttpResponse:
    scope = scope_or_404(slug, name)
    asked = request.GET.get("list", "waiting")
    shown = asked if asked in LISTS else "waiting"
    page = Paginator(LISTS[shown](scope), ROWS_PER_PAGE).get_page(request.GET.get("page"))
    context = {
        "section": "datasets",
        "tab": "campaigns" if scope.campaign else "review",
        "dataset": scope.dataset,
        "campaign": scope.campaign,
        "counts": queue.counts(scope),
        "shown": shown,
        "page": page,
        "rows": [row_of(scope, row, request.user, shown) for row in page],
    }
    return render(request, "review/queue.html", context)


def row_of(scope: queue.Scope, row: Any, user: Any, shown: str) -> dict[str, Any]:
    assignment = row if shown in {"waiting", "returned"} else row.assignment
    return {
        "it": row,
        "assignment": assignment,
        "choice": getattr(assignment, "review_choice", None) if shown == "waiting" else None,
        "own": own_work(user, assignment.worker),
        "desk": address(scope, "appeal" if shown == "appeals" else "desk", assignment.pk),
    }


urlpatterns = [
    path("datasets/<slug:slug>/review/", waiting, name="dataset-review"),
    path("datasets/<slug:slug>/campaigns/<str:name>/review/", waiting, name="campaign-review"),
]
