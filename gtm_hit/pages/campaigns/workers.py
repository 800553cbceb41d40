"""The workers of a campaign, and one of them as the manager sees them."""

from __future__ import annotations

from django import forms
from django.contrib import messages
from django.core.paginator import Paginator
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_POST, require_safe

from gtm_hit.models import Campaign, Worker
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import overview, seats, standing, tables
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.campaigns.seen import seen
from gtm_hit.ops.work import links
from gtm_hit.ops.work.workers import MAX_ID
from gtm_hit.pages.campaigns.common import frame, worker_or_404
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.attachments import csv_attachment
from gtm_hit.pages.common.campaign_choice import campaign_or_404

ROWS_PER_PAGE = 50


class InviteForm(forms.Form):
    worker = forms.CharField(label=gettext_lazy("The platform's id, or a pseudonym"), max_length=MAX_ID)


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MANAGER)
def workers(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    form = InviteForm(request.POST or None)
    if request.method == "POST" and form.is_valid():
        try:
            row = standing.invite(campaign, form.cleaned_data["worker"], request.user)
        except CampaignError as error:
            form.add_error("worker", str(error))
        else:
            messages.success(request, _("%(name)s is invited.") % {"name": row.worker.pseudonym})
            return redirect("campaign-workers", slug=slug, name=name)
    search = request.GET.get("q", "").strip().replace("\x00", "")[:MAX_ID]
    page = Paginator(overview.workers(campaign, search), ROWS_PER_PAGE).get_page(request.GET.get("page"))
    rows = overview.worker_rows(campaign, page.object_list)
    context = frame(campaign, "campaign-workers", form=form, page=page, rows=rows, search=search)
    return render(request, "campaigns/workers.html", context, status=400 if form.errors else 200)


@require_safe
@never_cache
@needs(Role.MANAGER)
def worker(request: HttpRequest, slug: str, name: str, pseudonym: str) -> HttpResponse:
    campaign, found = here(slug, name, pseudonym)
    rows = overview.assignments(campaign, found)
    page = Paginator(rows, ROWS_PER_PAGE).get_page(request.GET.get("page"))
    known = overview.workers(campaign).filter(pk=found.pk)
    row = next(iter(overview.worker_rows(campaign, known)), None)
    decided = campaign.workers.filter(worker=found).select_related("changed_by").first()
    batches = overview.with_sums(page.object_list)
    context = frame(campaign, "campaign-workers", worker=found, row=row, decided=decided, page=page)
    context |= {"batches": batches, "seen": seen(campaign, found)}
    return render(request, "campaigns/worker.html", context)


@require_POST
@needs(Role.MANAGER)
def decide(request: StaffRequest, slug: str, name: str, pseudonym: str) -> HttpResponse:
    """Invite, block, neither; or end the addresses that lead to their work."""
    campaign, found = here(slug, name, pseudonym)
    deed = request.POST.get("deed", "")
    try:
        messages.success(request, done(campaign, found, deed, request))
    except CampaignError as error:
        messages.error(request, str(error))
    return redirect("campaign-worker", slug=slug, name=name, pseudonym=pseudonym)


def done(campaign: Campaign, worker: Worker, deed: str, request: StaffRequest) -> str:
    match deed:
        case "invite":
            standing.put(campaign, worker, standing.Standing.INVITED, "", request.user)
            return _("The worker is invited.")
        case "block":
            standing.block(campaign, worker, request.POST.get("reason", ""), request.user)
            return _("The worker is blocked: what is taken may be finished, nothing more is handed out.")
        case "forget":
            standing.forget(campaign, worker)
            return _("The rules for everybody count for this worker again.")
        case "revoke-links":
            seats.revoke(worker, request.user)
            return _("None of the worker's links opens anything any more. Send out a new personal link.")
        case "revoke-link":
            revoke_one(campaign, worker, request.POST.get("assignment", ""))
            return _("The batch's link was revoked; the worker's start page has a new one.")
    raise CampaignError(_("There is nothing of that name to do with a worker; nothing was changed."), "deed")


def revoke_one(campaign: Campaign, worker: Worker, pk: str) -> None:
    rows = worker.assignments.filter(batch__campaign=campaign)
    found = rows.filter(pk=int(pk)).first() if pk.isdecimal() and len(pk) < 19 else None
    if found is None:
        raise Http404
    links.revoke_assignment(found)


def here(slug: str, name: str, pseudonym: str) -> tuple[Campaign, Worker]:
    campaign = campaign_or_404(slug, name)
    return campaign, worker_or_404(campaign, pseudonym)


@require_safe
@needs(Role.MANAGER)
def workers_csv(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    return csv_attachment(tables.workers_csv(campaign), f"{campaign.name}-workers.csv")


@require_safe
@needs(Role.MANAGER)
def worker_csv(request: HttpRequest, slug: str, name: str, pseudonym: str) -> HttpResponse:
    campaign, found = here(slug, name, pseudonym)
    return csv_attachment(tables.assignments_csv(campaign, found), f"{campaign.name}-{found.pseudonym}.csv")


ALL = "datasets/<slug:slug>/campaigns/<str:name>/"
ONE = f"{ALL}workers/<str:pseudonym>/"
urlpatterns = [
    path(f"{ALL}workers/", workers, name="campaign-workers"),
    path(f"{ALL}workers.csv", workers_csv, name="campaign-workers-csv"),
    path(ONE, worker, name="campaign-worker"),
    path(f"{ONE}decide/", decide, name="campaign-worker-decide"),
    path(f"{ONE}batches.csv", worker_csv, name="campaign-worker-csv"),
]
