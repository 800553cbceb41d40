"""The campaigns of a dataset, and one of them: how it goes, and its states."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.safestring import mark_safe
from django.utils.translation import gettext as _
from django.views.decorators.http import require_POST, require_safe

from gtm_hit.metrics.figures import svg
from gtm_hit.metrics.figures.progress import Band, frames_over_time
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import overview, states, tables
from gtm_hit.ops.campaigns.course import Course, course
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.campaigns.estimate import estimate
from gtm_hit.pages.campaigns.common import frame
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.common.attachments import csv_attachment
from gtm_hit.pages.common.campaign_choice import campaign_or_404
from gtm_hit.pages.datasets.listing import dataset_or_404


@require_safe
@needs(Role.MANAGER)
def campaigns(request: HttpRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    context = {"section": "datasets", "tab": "campaigns", "dataset": dataset}
    return render(request, "campaigns/list.html", {**context, "campaigns": overview.campaigns(dataset)})


@require_safe
@needs(Role.MANAGER)
def campaign(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    found = campaign_or_404(slug, name)
    going = course(found)
    context = frame(
        found,
        "campaign",
        course=going,
        figure=mark_safe(figure(going)) if going.moments else "",
        estimate=estimate(found),
        money=overview.money(found),
        working=overview.working_now(found),
        waiting=overview.waiting(found),
        steps=[(step, states.MEANS[step]) for step in states.steps(found)],
    )
    return render(request, "campaigns/overview.html", context)


def figure(going: Course) -> str:
    bands = [
        Band(_("accepted"), svg.GREEN, 0.75, [moment.accepted for moment in going.moments]),
        Band(_("submitted"), svg.BLUE, 0.5, [moment.submitted for moment in going.moments]),
        Band(_("in work"), svg.AMBER, 0.3, [moment.in_work for moment in going.moments]),
    ]
    times = [moment.at for moment in going.moments]
    return frames_over_time(times, bands, going.frames, title=_("Frames by state over time"))


@require_POST
@needs(Role.MANAGER)
def step(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    """Open, pause or close."""
    found = campaign_or_404(slug, name)
    try:
        after = states.take(found, request.POST.get("step", ""))
    except CampaignError as error:
        messages.error(request, str(error))
    else:
        text = _("The campaign is %(state)s now.")
        messages.success(request, text % {"state": after.get_state_display()})
    return redirect("campaign", slug=slug, name=name)


@require_safe
@needs(Role.MANAGER)
def batches_csv(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    found = campaign_or_404(slug, name)
    return csv_attachment(tables.assignments_csv(found), f"{found.name}-batches.csv")


ONE = "datasets/<slug:slug>/campaigns/<str:name>/"
urlpatterns = [
    path("datasets/<slug:slug>/campaigns/", campaigns, name="campaigns"),
    path(ONE, campaign, name="campaign"),
    path(f"{ONE}step/", step, name="campaign-step"),
    path(f"{ONE}batches.csv", batches_csv, name="campaign-batches-csv"),
]
