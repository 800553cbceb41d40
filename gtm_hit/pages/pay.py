"""What workers of a campaign earned, what an hour came to, and paying them."""

from __future__ import annotations

from decimal import Decimal

from django import forms
from django.contrib import messages
from django.core.paginator import Paginator
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy, ngettext
from django.views.decorators.http import require_http_methods, require_POST, require_safe

from gtm_hit.models import Campaign, MoneyEntry
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.outbox import planning
from gtm_hit.ops.pay import csv_files, ledger, table
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.attachments import csv_attachment
from gtm_hit.pages.common.campaign_choice import campaign_or_404

WORKERS_PER_PAGE = 100
LINES_SHOWN = 30


class AmountForm(forms.Form):
    worker = forms.CharField(max_length=20)
    amount = forms.DecimalField(
        label=gettext_lazy("Amount"),
        max_digits=9,
        decimal_places=2,
        required=False,
        min_value=Decimal("0.01"),
    )
    note = forms.CharField(label=gettext_lazy("Note"), max_length=300, required=False)


@require_safe
@needs(Role.MANAGER)
def pay(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    lines = table.workers(campaign)
    context = {
        **frame(campaign),
        "totals": table.totals(campaign, lines),
        "page": Paginator(lines, WORKERS_PER_PAGE).get_page(request.GET.get("page")),
        "proposed": sum(1 for each in lines if each.proposed),
        "due": sum(1 for each in lines if each.balance.to_pay),
        "lines": [(line, ledger.can_be_taken_back(line)) for line in table.lines_of(campaign)[:LINES_SHOWN]],
        "platform_pays": campaign.platform in planning.PLATFORMS,
        "paying": request.GET.get("pay", ""),
    }
    return render(request, "campaigns/pay.html", context)


@require_POST
@needs(Role.MANAGER)
def bonuses(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    """Approve what is proposed for everybody, or for the one named, with another amount if there is one."""
    campaign, form = campaign_or_404(slug, name), AmountForm(request.POST)
    one = bool(request.POST.get("worker"))
    if one and not form.is_valid():
        return back_with(request, campaign, told(form))
    only = [form.cleaned_data["worker"]] if one else None
    amount = form.cleaned_data["amount"] if one else None
    try:
        added = table.approve_bonuses(campaign, request.user, only, amount)
    except OperationError as error:
        return back_with(request, campaign, str(error))
    total = sum((entry.amount for entry in added), Decimal(0))
    text = ngettext(
        "%(count)d bonus was approved: %(total)s %(currency)s.",
        "%(count)d bonuses were approved: %(total)s %(currency)s in all.",
        len(added),
    )
    values = {"count": len(added), "total": total, "currency": campaign.currency}
    messages.success(request, text % values)
    return redirect("campaign-pay", slug=slug, name=name)


@require_POST
@needs(Role.MANAGER)
def paid(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    """Somebody was paid by other ways."""
    campaign, form = campaign_or_404(slug, name), AmountForm(request.POST)
    if not form.is_valid():
        return back_with(request, campaign, told(form))
    try:
        worker = table.worker_named(campaign, form.cleaned_data["worker"])
        entry = ledger.mark_paid(
            campaign, worker, request.user, form.cleaned_data["amount"], form.cleaned_data["note"]
        )
    except OperationError as error:
        return back_with(request, campaign, str(error))
    words = _("%(amount)s %(currency)s to %(worker)s are marked as paid.")
    values = {"amount": entry.amount, "currency": entry.currency, "worker": worker.pseudonym}
    messages.success(request, words % values)
    return redirect("campaign-pay", slug=slug, name=name)


@require_POST
@needs(Role.MANAGER)
def take_back(request: StaffRequest, slug: str, name: str, pk: int) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    entry = get_object_or_404(MoneyEntry.objects.select_related("campaign"), pk=pk, campaign=campaign)
    try:
        ledger.take_back(entry, request.user, request.POST.get("note", ""))
    except OperationError as error:
        return back_with(request, campaign, str(error))
    messages.success(request, _("The line is taken back by a new one."))
    return redirect("campaign-pay", slug=slug, name=name)


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MANAGER)
def payout(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    """First what would be sent, by whom to whom; then, on a press, it is planned."""
    campaign = campaign_or_404(slug, name)
    try:
        if request.method == "POST":
            planning.plan_payouts(campaign, request.user)
            return redirect("campaign-platform", slug=slug, name=name)
        rows = planning.preview(campaign)
    except OperationError as error:
        return back_with(request, campaign, str(error))
    total = sum((row.amount for row in rows), Decimal(0))
    context = {**frame(campaign), "rows": rows, "total": total}
    return render(request, "campaigns/payout.html", context)


@require_safe
@needs(Role.MANAGER)
def as_csv(request: HttpRequest, slug: str, name: str, what: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    text = csv_files.workers(campaign) if what == "workers" else csv_files.ledger_lines(campaign)
    return csv_attachment(text, f"{slug}-{name}-{what}.csv")


def frame(campaign: Campaign) -> dict[str, object]:
    return {
        "section": "datasets",
        "tab": "campaigns",
        "dataset": campaign.dataset,
        "campaign": campaign,
    }


def told(form: forms.Form) -> str:
    return " ".join(str(error) for errors in form.errors.values() for error in errors)


def back_with(request: HttpRequest, campaign: Campaign, error: str) -> HttpResponse:
    messages.error(request, error)
    return redirect("campaign-pay", slug=campaign.dataset.slug, name=campaign.name)


PLACE = "datasets/<slug:slug>/campaigns/<str:name>/pay/"
urlpatterns = [
    path(PLACE, pay, name="campaign-pay"),
    path(f"{PLACE}bonuses/", bonuses, name="campaign-bonuses"),
    path(f"{PLACE}paid/", paid, name="campaign-paid"),
    path(f"{PLACE}payout/", payout, name="campaign-payout"),
    path(f"{PLACE}lines/<int:pk>/take-back/", take_back, name="campaign-take-back"),
    path(f"{PLACE}workers.csv", as_csv, {"what": "workers"}, name="campaign-pay-csv"),
    path(f"{PLACE}ledger.csv", as_csv, {"what": "ledger"}, name="campaign-ledger-csv"),
]
