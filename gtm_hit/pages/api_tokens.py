"""Keys for scripts."""

from __future__ import annotations

from datetime import timedelta

from django import forms
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import path
from django.utils import timezone
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_POST

from gtm_hit.models import ApiToken
from gtm_hit.ops import api_tokens
from gtm_hit.ops.access.roles import SEES
from gtm_hit.pages.common.access import StaffRequest, needs

SCOPES = [
    (ApiToken.Scope.READ.value, gettext_lazy("read everything")),
    (ApiToken.Scope.IMPORT.value, gettext_lazy("bring datasets and annotations in")),
    (ApiToken.Scope.WORK.value, gettext_lazy("make batches, get the workers' link, save frames")),
    (ApiToken.Scope.RELEASE.value, gettext_lazy("export and release")),
]


class TokenForm(forms.Form):
    name = forms.CharField(label=gettext_lazy("What it is used for"), max_length=100)
    scopes = forms.MultipleChoiceField(
        label=gettext_lazy("What it may do"),
        choices=SCOPES,
        widget=forms.CheckboxSelectMultiple,
        initial=[ApiToken.Scope.READ.value],
    )
    days = forms.IntegerField(
        label=gettext_lazy("Valid for days"),
        min_value=1,
        max_value=3650,
        required=False,
        initial=365,
        help_text=gettext_lazy("Empty: until it is revoked."),
    )


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@needs(SEES)
def tokens(request: StaffRequest) -> HttpResponse:
    form, key = TokenForm(request.POST or None), ""
    if request.method == "POST" and form.is_valid():
        chosen = form.cleaned_data
        expires_at = timezone.now() + timedelta(days=chosen["days"]) if chosen["days"] else None
        try:
            _token, key = api_tokens.make(request.user, chosen["name"], chosen["scopes"], expires_at)
            form = TokenForm()
        except api_tokens.TokenError as error:
            form.add_error(None, str(error))
    context = {
        "section": "tokens",
        "form": form,
        "key": key,  # in this answer and nowhere else
        "tokens": api_tokens.visible_to(request.user),
        "valid": set(api_tokens.valid().values_list("pk", flat=True)),
    }
    return render(request, "staff/tokens.html", context)


@require_POST
@needs(SEES)
def revoke(request: StaffRequest, pk: int) -> HttpResponse:
    api_tokens.revoke(get_object_or_404(api_tokens.visible_to(request.user), pk=pk))
    return redirect("tokens")


urlpatterns = [
    path("tokens/", tokens, name="tokens"),
    path("tokens/<int:pk>/revoke/", revoke, name="token-revoke"),
]
