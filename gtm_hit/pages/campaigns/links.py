"""A campaign's links: what to paste where, made, rotated, revoked."""

from __future__ import annotations

from dataclasses import dataclass

from django import forms
from django.contrib import messages
from django.core.paginator import Paginator
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path, reverse
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_POST

from gtm_hit.crowd.platforms import platform_of
from gtm_hit.models import Campaign, CampaignLink
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import links, standing
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work.workers import MAX_ID
from gtm_hit.pages.campaigns.common import frame
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.campaign_choice import campaign_or_404

ROWS_PER_PAGE = 50


class LinkForm(forms.Form):
    kind = forms.ChoiceField(label=gettext_lazy("Kind"), choices=CampaignLink.Kind.choices)
    worker = forms.CharField(
        label=gettext_lazy("Worker, for a personal link: pseudonym or the platform's id"),
        max_length=MAX_ID,
        required=False,
    )
    note = forms.CharField(
        label=gettext_lazy("For whom (only managers read it)"), max_length=links.MAX_NOTE, required=False
    )
    days = forms.IntegerField(
        label=gettext_lazy("Days it is valid (empty: as usual)"),
        min_value=1,
        max_value=links.MAX_DAYS,
        required=False,
    )


@dataclass(frozen=True)
class Shown:
    link: CampaignLink
    address: str  # empty when it opens nothing any more


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@needs(Role.MANAGER)
def campaign_links(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    form = LinkForm(request.POST or None, initial={"kind": usual_kind(campaign)})
    if campaign.platform != Campaign.Platform.OWN_TEAM:
        form.fields["kind"].choices = [one for one in CampaignLink.Kind.choices if one[0] != "invitation"]  # type: ignore[attr-defined]
    if request.method == "POST" and form.is_valid():
        try:
            make(campaign, request, **form.cleaned_data)
            return redirect("campaign-links", slug=slug, name=name)
        except CampaignError as error:
            form.add_error(error.field if error.field in form.fields else None, str(error))
    found = campaign.links.select_related("worker", "created_by", "campaign__dataset")
    page = Paginator(found, ROWS_PER_PAGE).get_page(request.GET.get("page"))
    rows = [Shown(link, address(request, campaign, link)) for link in page.object_list]
    context = frame(campaign, "campaign-links", form=form, page=page, rows=rows)
    return render(request, "campaigns/links.html", context, status=400 if form.errors else 200)


def usual_kind(campaign: Campaign) -> str:
    own = campaign.platform == Campaign.Platform.OWN_TEAM
    return CampaignLink.Kind.INVITATION if own else CampaignLink.Kind.GENERAL


def make(
    campaign: Campaign, request: StaffRequest, kind: str, worker: str, note: str, days: int | None
) -> None:
    whose = None
    if kind == CampaignLink.Kind.PERSONAL and worker.strip():
        whose = standing.known_or_new(campaign, worker)
    links.make(campaign, kind, worker=whose, note=note, days=days, user=request.user)
    messages.success(request, _("The link was made."))


def address(request: HttpRequest, campaign: Campaign, link: CampaignLink) -> str:
    """What is pasted into the platform, or sent to somebody."""
    if link.state != "open":
        return ""
    view = "invitation" if link.kind == CampaignLink.Kind.INVITATION else "join"
    plain = request.build_absolute_uri(reverse(view, args=[links.token(link)]))
    general = link.kind == CampaignLink.Kind.GENERAL
    return platform_of(campaign).entry_address(plain) if general else plain


@require_POST
@needs(Role.MANAGER)
def change(request: StaffRequest, slug: str, name: str, pk: int) -> HttpResponse:
    """Revoke or rotate."""
    link = CampaignLink.objects.select_related("campaign").filter(pk=pk, campaign=campaign_or_404(slug, name))
    found = link.first()
    deed = {"revoke": links.revoke, "rotate": links.rotate}.get(request.POST.get("deed", ""))
    if found is None:
        raise Http404
    try:
        if deed is None:
            raise CampaignError(_("A link is revoked or given a new address; nothing was changed."), "deed")
        deed(found)
    except CampaignError as error:
        messages.error(request, str(error))
    return redirect("campaign-links", slug=slug, name=name)


urlpatterns = [
    path("datasets/<slug:slug>/campaigns/<str:name>/links/", campaign_links, name="campaign-links"),
    path("datasets/<slug:slug>/campaigns/<str:name>/links/<int:pk>/", change, name="campaign-link"),
]
