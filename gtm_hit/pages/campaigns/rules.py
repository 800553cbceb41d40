"""New campaigns, and the rules of those there are."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.views.decorators.http import require_http_methods

from gtm_hit.models import Campaign
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import editing
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.campaigns.estimate import estimate
from gtm_hit.pages.campaigns.common import frame
from gtm_hit.pages.campaigns.form import CampaignForm
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.campaign_choice import campaign_or_404
from gtm_hit.pages.datasets.listing import dataset_or_404


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MANAGER)
def new(request: StaffRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    draft = Campaign(dataset=dataset)
    form = CampaignForm(request.POST or None, instance=draft)
    if request.method == "POST" and form.is_valid():
        try:
            made = editing.create(dataset, form.values(), request.user)
        except CampaignError as error:
            blame(form, error)
        else:
            messages.success(request, _("The campaign is a draft. Look at its rules, then open it."))
            return redirect("campaign", slug=slug, name=made.name)
    context = {"section": "datasets", "tab": "campaigns", "dataset": dataset, "form": form}
    context["estimate"] = estimate(Campaign(dataset=dataset))
    return render(request, "campaigns/new.html", context, status=400 if form.errors else 200)


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MANAGER)
def rules(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    form = CampaignForm(request.POST or None, instance=campaign_or_404(slug, name))
    if request.method == "POST" and form.is_valid():
        try:
            changed = editing.edit(campaign, form.values())
        except CampaignError as error:
            blame(form, error)
        else:
            messages.success(request, _("The rules were changed."))
            return redirect("campaign-rules", slug=slug, name=changed.name)
    context = frame(campaign, "campaign-rules", form=form, estimate=estimate(campaign))
    return render(request, "campaigns/rules.html", context, status=400 if form.errors else 200)


def blame(form: CampaignForm, error: CampaignError) -> None:
    form.add_error(error.field if error.field in form.fields else None, str(error))


urlpatterns = [
    path("datasets/<slug:slug>/campaigns/new/", new, name="campaign-new"),
    path("datasets/<slug:slug>/campaigns/<str:name>/rules/", rules, name="campaign-rules"),
]
