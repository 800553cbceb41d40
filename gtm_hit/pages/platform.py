"""A campaign's platform: its study, and what is told there."""

from __future__ import annotations

from collections.abc import Callable

from django import forms
from django.conf import settings
from django.contrib import messages
from django.core.paginator import Paginator
from django.http import Http404, HttpRequest, HttpResponse
from django.http.response import HttpResponseBase
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import path, reverse
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy, ngettext
from django.views.decorators.http import require_POST, require_safe

from gtm_hit.crowd.prolific import connect
from gtm_hit.models import Campaign, OutboxRow
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.outbox import (
    accounts,
    handover,
    overview,
    planning,
    return_requests,
    rows,
    sending,
    statuses,
    studies,
)
from gtm_hit.ops.outbox.platform import StudyDraft
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.attachments import csv_attachment
from gtm_hit.pages.common.campaign_choice import campaign_or_404
from gtm_hit.pages.pay import frame, told

ROWS_PER_PAGE = 50
SECRET = forms.PasswordInput(attrs={"autocomplete": "off"})


class AccountForm(forms.Form):
    address = forms.ChoiceField(label=gettext_lazy("Address of the platform"), required=False)
    study = forms.CharField(
        label=gettext_lazy("Study"),
        max_length=64,
        required=False,
        help_text=gettext_lazy("Its number at Prolific, if it was made there."),
    )
    token = forms.CharField(
        label=gettext_lazy("Key"),
        max_length=200,
        required=False,
        widget=SECRET,
        help_text=gettext_lazy("Empty: as it is. A single dash: none any more."),
    )
    hook_secret = forms.CharField(
        label=gettext_lazy("Secret of its messages"),
        max_length=200,
        required=False,
        widget=SECRET,
        help_text=gettext_lazy("Empty: as it is. A single dash: none any more."),
    )

    def __init__(self, *args: object, **kwargs: object) -> None:
        super().__init__(*args, **kwargs)  # type: ignore[arg-type]
        choices = [(each, each) for each in settings.PROLIFIC_ADDRESSES]
        self.fields["address"].choices = choices  # type: ignore[attr-defined]


class StudyForm(forms.Form):
    title = forms.CharField(label=gettext_lazy("Title"), max_length=200)
    description = forms.CharField(
        label=gettext_lazy("Description"), widget=forms.Textarea(attrs={"rows": 4}), max_length=5000
    )
    address = forms.CharField(
        label=gettext_lazy("Address workers are sent to"),
        max_length=1000,
        help_text=gettext_lazy("The campaign's link; Prolific's placeholders for who comes are added."),
    )
    places = forms.IntegerField(label=gettext_lazy("Places"), min_value=1, max_value=100_000)
    minutes = forms.IntegerField(label=gettext_lazy("Minutes"), min_value=1, max_value=1440)
    reward = forms.DecimalField(label=gettext_lazy("Reward"), max_digits=7, decimal_places=2, min_value=0)
    completion_code = forms.RegexField(
        r"^[A-Za-z0-9_-]{4,40}\Z", label=gettext_lazy("Completion code"), max_length=40
    )


@require_safe
@needs(Role.MANAGER)
def platform(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    return shown(request, campaign_or_404(slug, name))


def shown(
    request: HttpRequest, campaign: Campaign, study: StudyForm | None = None, status: int = 200
) -> HttpResponse:
    account = accounts.of(campaign)
    first = {"address": account.address, "study": account.study}
    decides = campaign.platform in planning.PLATFORMS
    page = Paginator(overview.listed(campaign), ROWS_PER_PAGE).get_page(request.GET.get("page"))
    context = {
        **frame(campaign),
        "account": account,
        "decides": decides,
        "has_key": accounts.has_key(account),
        "own_key": bool(account.token),
        "account_form": AccountForm(initial=first),
        "study_form": study or StudyForm(initial=vars(studies.proposed(campaign))),
        "hook": hook_of(request, campaign),
        "counts": overview.counts(campaign),
        "next_run": overview.next_run(campaign),
        "page": page,
        "files": files(campaign) if decides else [],
        "unmatched": statuses.unmatched(campaign) if decides else 0,
    }
    return render(request, "campaigns/platform.html", context, status=status)


def hook_of(request: HttpRequest, campaign: Campaign) -> str:
    return request.build_absolute_uri(reverse("hook-prolific", args=[campaign.dataset.slug, campaign.name]))


def files(campaign: Campaign) -> list[tuple[str, handover.Handover]]:
    made = ((name, handover.made(campaign, name)) for name in handover.KINDS)
    return [(name, each) for name, each in made if each.rows]


def press(action: Callable[[StaffRequest, Campaign], str]) -> Callable[..., HttpResponseBase]:
    """A button of the page: what it did, or why it did not, is said on the page."""

    @require_POST
    @needs(Role.MANAGER)
    def pressed(request: StaffRequest, slug: str, name: str) -> HttpResponse:
        campaign = campaign_or_404(slug, name)
        try:
            messages.success(request, action(request, campaign))
        except OperationError as error:
            messages.error(request, str(error))
        return redirect("campaign-platform", slug=slug, name=name)

    return pressed


@press
def account(request: StaffRequest, campaign: Campaign) -> str:
    form = AccountForm(request.POST)
    if not form.is_valid():
        raise accounts.AccountError(told(form))
    accounts.configure(campaign, request.user, **form.cleaned_data)
    return _("How the platform is reached was changed.")


@require_POST
@needs(Role.MANAGER)
def draft(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    """Unlike the other buttons it keeps what was typed when the platform does not like it."""
    campaign, form = campaign_or_404(slug, name), StudyForm(request.POST)
    if form.is_valid():
        try:
            studies.draft(campaign, connect(campaign), StudyDraft(**form.cleaned_data), request.user)
        except OperationError as error:
            form.add_error(None, str(error))
        else:
            messages.success(request, _("The study is drafted. Nobody sees it before it is published."))
            return redirect("campaign-platform", slug=slug, name=name)
    return shown(request, campaign, form, status=400)


@press
def messages_here(request: StaffRequest, campaign: Campaign) -> str:
    workspace = request.POST.get("workspace", "").strip()[:64]
    studies.have_messages_sent(
        campaign, connect(campaign), workspace, hook_of(request, campaign), request.user
    )
    return _("Prolific sends its messages here from now on.")


@press
def study(request: StaffRequest, campaign: Campaign) -> str:
    action = request.POST.get("action", "")
    if action == "look":
        found, at_platform = studies.look(campaign, connect(campaign))
        words = _("The study is %(state)s: %(taken)d of %(places)d places are taken.")
        values = {
            "state": found.study_state,
            "taken": at_platform.taken,
            "places": at_platform.places,
        }
        return words % values
    changed = studies.change(campaign, connect(campaign), action, request.user)
    return _("The study is %(state)s now.") % {"state": changed.study_state}


@require_POST
@needs(Role.MANAGER)
def send(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    if not accounts.has_key(accounts.of(campaign)):
        messages.error(request, _("There is no key for the platform: everything goes by files."))
        return redirect("campaign-platform", slug=slug, name=name)
    return redirect("job", pk=sending.start(campaign, request.user).pk)


@require_POST
@needs(Role.MANAGER)
def row(request: StaffRequest, slug: str, name: str, pk: int) -> HttpResponse:
    """What a person decides about one row."""
    found = get_object_or_404(OutboxRow, pk=pk, campaign=campaign_or_404(slug, name))
    try:
        rows.decide(found, request.POST.get("action", ""), request.user)
    except OperationError as error:
        messages.error(request, str(error))
    else:
        messages.success(request, _("Done."))
    return redirect("campaign-platform", slug=slug, name=name)


@require_safe
@needs(Role.MANAGER)
def file(request: HttpRequest, slug: str, name: str, what: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    upto = request.GET.get("upto", "")
    try:
        made = handover.made(campaign, what, int(upto) if upto.isdecimal() else None)
    except handover.HandoverError as error:
        raise Http404(str(error)) from None
    return csv_attachment(made.text, f"{slug}-{name}-{what}.csv")


@press
def file_done(request: StaffRequest, campaign: Campaign) -> str:
    upto = request.POST.get("upto", "")
    if not upto.isdecimal() or len(upto) > 18:
        raise handover.HandoverError(_("Say up to which row."))
    number = handover.done(campaign, request.POST.get("what", ""), int(upto), request.user)
    text = ngettext("%(count)d row is done.", "%(count)d rows are done.", number)
    return text % {"count": number}


@press
def return_request(request: StaffRequest, campaign: Campaign) -> str:
    submission, reason = request.POST.get("submission", ""), request.POST.get("reason", "")
    row = return_requests.plan(campaign, submission, reason, request.user)
    return _("Planned: %(worker)s is asked to give the submission back.") % {"worker": row.worker.pseudonym}


@press
def submissions(request: StaffRequest, campaign: Campaign) -> str:
    sent = request.FILES.get("file")
    if sent is None or isinstance(sent, list):
        raise handover.HandoverError(_("Choose a file."))
    content = sent.read(handover.MOST_BYTES + 1)
    lines, news = handover.take_in(campaign, content)
    text = ngettext(
        "%(lines)d submission was read; news: %(news)d.",
        "%(lines)d submissions were read; news: %(news)d.",
        lines,
    )
    return text % {"lines": lines, "news": news}


PLACE = "datasets/<slug:slug>/campaigns/<str:name>/platform/"
urlpatterns = [
    path(PLACE, platform, name="campaign-platform"),
    path(f"{PLACE}account/", account, name="campaign-account"),
    path(f"{PLACE}draft/", draft, name="campaign-draft"),
    path(f"{PLACE}study/", study, name="campaign-study"),
    path(f"{PLACE}messages/", messages_here, name="campaign-messages"),
    path(f"{PLACE}return-requests/", return_request, name="campaign-return-request"),
    path(f"{PLACE}send/", send, name="campaign-send"),
    path(f"{PLACE}rows/<int:pk>/", row, name="campaign-outbox-row"),
    path(f"{PLACE}files/done/", file_done, name="campaign-file-done"),
    path(f"{PLACE}files/<slug:what>.csv", file, name="campaign-file"),
    path(f"{PLACE}submissions/", submissions, name="campaign-submissions"),
]
