"""An invitation to the own team: a name and a password make the account, or one that is there is taken in."""

from __future__ import annotations

from typing import cast

from django import forms
from django.contrib.auth import login
from django.contrib.auth.models import User
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.debug import sensitive_post_parameters
from django.views.decorators.http import require_http_methods

from gtm_hit.models import CampaignLink
from gtm_hit.ops.campaigns import accounts
from gtm_hit.ops.campaigns import links as campaign_links
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work import links
from gtm_hit.pages.work.workplace import valid_links_only


class AccountForm(forms.Form):
    username = forms.CharField(
        label=gettext_lazy("Name to log in with"),
        max_length=150,
        widget=forms.TextInput(attrs={"autocomplete": "username", "autocapitalize": "none"}),
    )
    password = forms.CharField(
        label=gettext_lazy("Password, at least 8 characters"),
        strip=False,
        widget=forms.PasswordInput(attrs={"autocomplete": "new-password"}),
    )


@sensitive_post_parameters("password")
@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@valid_links_only
def invitation(request: HttpRequest, token: str) -> HttpResponse:
    link = campaign_links.find(token)
    if link.kind != CampaignLink.Kind.INVITATION:
        raise links.BadToken("no invitation")
    if link.state != "open":
        return render(request, "work/invitation_over.html", {"campaign": link.campaign}, status=410)
    if request.user.is_authenticated:
        return taken_in(request, link)
    form = AccountForm(request.POST or None)
    if request.method == "POST" and form.is_valid():
        try:
            user = accounts.accept(link, **form.cleaned_data)
        except CampaignError as error:
            form.add_error(error.field if error.field in form.fields else None, str(error))
        else:
            login(request, user)
            return redirect("my-work")
    context = {"campaign": link.campaign, "form": form}
    return render(request, "work/invitation.html", context, status=400 if form.errors else 200)


def taken_in(request: HttpRequest, link: CampaignLink) -> HttpResponse:
    if request.method != "POST":
        return render(request, "work/invitation.html", {"campaign": link.campaign})
    try:
        accounts.join(link, cast(User, request.user))
    except CampaignError:
        return render(request, "work/invitation_over.html", {"campaign": link.campaign}, status=410)
    return redirect("my-work")


urlpatterns = [path("invitation/<str:token>/", invitation, name="invitation")]
