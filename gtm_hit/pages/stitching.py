"""Ground truth out of accepted batches: running it, how far it is, and the questions it leaves."""

from __future__ import annotations

from typing import Any

from django import forms
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import get_script_prefix, path, reverse
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_safe

from gtm_hit.models import StitchConflict
from gtm_hit.ops.access.roles import Role, may
from gtm_hit.ops.stitching import overview, running
from gtm_hit.ops.stitching.scope import Scope, StitchingError, named
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.datasets.listing import dataset_or_404

DECIDED_SHOWN = 50
WORKERS_SHOWN = 50


class RulesForm(forms.Form):
    gate = forms.FloatField(
        label=gettext_lazy("Gate, metres"),
        initial=running.Asked.gate,
        min_value=0.01,
        max_value=10,
        help_text=gettext_lazy("How far apart two workers may put one person in a frame they share."),
    )
    gap = forms.IntegerField(
        label=gettext_lazy("Gap, frames"),
        initial=running.Asked.gap,
        min_value=0,
        max_value=10_000,
        help_text=gettext_lazy("For how long somebody may be missing and still go on."),
    )
    margin = forms.FloatField(
        label=gettext_lazy("Margin, log odds"),
        initial=running.Asked.margin,
        min_value=0,
        max_value=100,
        help_text=gettext_lazy("A higher one asks more often; 3 means 20 to 1."),
    )
    return_seconds = forms.FloatField(
        label=gettext_lazy("Returns within, seconds"),
        initial=running.Asked.return_seconds,
        min_value=0,
        max_value=86_400,
        help_text=gettext_lazy("0: ask about nobody who left and came back."),
    )
    return_reach = forms.FloatField(
        label=gettext_lazy("Returns within, metres"),
        initial=running.Asked.return_reach,
        min_value=0,
        max_value=1000,
    )


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@needs(Role.REVIEWER)
def stitching(request: StaffRequest, slug: str, name: str = "") -> HttpResponse:
    scope = scope_or_404(slug, name)
    found = overview.overview(scope)
    runs = may(request.user, Role.MANAGER, scope.dataset)
    form = RulesForm(request.POST or None, initial=found.run.rules if found.run else None)
    if request.method == "POST":
        return _start(request, scope, form, found) if runs else HttpResponse(status=403)
    return _page(request, scope, form, found)


def _start(request: StaffRequest, scope: Scope, form: RulesForm, found: overview.Overview) -> HttpResponse:
    if form.is_valid():
        try:
            running.start(scope, running.Asked(**form.cleaned_data), request.user)
            return redirect(address("stitching", scope))
        except StitchingError as error:
            form.add_error(None, str(error))
    return _page(request, scope, form, found)


def _page(request: StaffRequest, scope: Scope, form: RulesForm, found: overview.Overview) -> HttpResponse:
    context = {
        **frame(scope),
        "form": form,
        "found": found,
        "numbers": found.run.numbers if found.run else None,
        "workers": found.run.numbers["workers"][:WORKERS_SHOWN] if found.run else [],
        "percent": 100 * found.job.done // found.job.total if found.job and found.job.total else 0,
        "may_run": may(request.user, Role.MANAGER, scope.dataset),
        "decided": overview.conflicts(scope, StitchConflict.State.DECIDED).order_by("-decided_at")[
            :DECIDED_SHOWN
        ],
        "returns": found.open - found.open_joins,
    }
    return render(request, "stitching/stitching.html", context)


@require_safe
@never_cache
@needs(Role.REVIEWER)
def stitching_conflicts(request: HttpRequest, slug: str, name: str = "") -> HttpResponse:
    scope = scope_or_404(slug, name)
    ids = overview.conflicts(scope, StitchConflict.State.OPEN).values_list("pk", flat=True)
    api = f"{get_script_prefix()}api/v1/"
    context = {
        **frame(scope),
        "queue": {
            "ids": list(ids),
            "conflicts": f"{api}datasets/{slug}/stitching/conflicts/",
            "images": f"{api}images/",
        },
    }
    return render(request, "stitching/conflicts.html", context)


def frame(scope: Scope) -> dict[str, Any]:
    """What both pages have in common."""
    return {
        "section": "datasets",
        "tab": "campaigns" if scope.campaign else "stitching",
        "dataset": scope.dataset,
        "campaign": scope.campaign,
        "stitching_address": address("stitching", scope),
        "conflicts_address": address("conflicts", scope),
    }


def address(page: str, scope: Scope) -> str:
    if scope.campaign is None:
        return reverse(f"dataset-{page}", args=[scope.dataset.slug])
    return reverse(f"campaign-{page}", args=[scope.dataset.slug, scope.campaign.name])


def scope_or_404(slug: str, name: str) -> Scope:
    try:
        return named(dataset_or_404(slug), name)
    except StitchingError as error:
        raise Http404(_("There is no campaign “%(name)s”.") % {"name": name}) from error


CAMPAIGN = "datasets/<slug:slug>/campaigns/<str:name>/stitching/"

urlpatterns = [
    path("datasets/<slug:slug>/stitching/", stitching, name="dataset-stitching"),
    path("datasets/<slug:slug>/stitching/conflicts/", stitching_conflicts, name="dataset-conflicts"),
    path(CAMPAIGN, stitching, name="campaign-stitching"),
    path(f"{CAMPAIGN}conflicts/", stitching_conflicts, name="campaign-conflicts"),
]
