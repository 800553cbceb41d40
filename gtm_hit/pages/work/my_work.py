"""The page of somebody with an account: where they may work, and what came of it."""

from __future__ import annotations

from django.core.paginator import Paginator
from django.http import Http404, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_POST, require_safe

from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import accounts
from gtm_hit.ops.work import links
from gtm_hit.pages.common.access import StaffRequest, needs

ROWS_PER_PAGE = 50


@require_safe
@never_cache
@needs(Role.ANNOTATOR)
def my_work(request: StaffRequest) -> HttpResponse:
    page = Paginator(accounts.batches(request.user), ROWS_PER_PAGE).get_page(request.GET.get("page"))
    rows = [(one, links.assignment_token(one)) for one in page.object_list]
    context = {"section": "my-work", "places": accounts.places(request.user), "page": page, "rows": rows}
    return render(request, "work/my_work.html", context)


@require_POST
@needs(Role.ANNOTATOR)
def open_place(request: StaffRequest, pk: int) -> HttpResponse:
    """To the account's own seat in a campaign; the first time it becomes a worker by that."""
    place = next((one for one in accounts.places(request.user) if one.campaign.pk == pk), None)
    if place is None:
        raise Http404
    seat = links.Seat(accounts.worker_of(request.user), place.campaign.dataset, place.campaign)
    return redirect("work-home", token=links.seat_token(seat))


urlpatterns = [
    path("my-work/", my_work, name="my-work"),
    path("my-work/<int:pk>/", open_place, name="my-work-open"),
]
