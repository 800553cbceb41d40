"""Who has which role, for one dataset and for all of them; given and taken by administrators."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.core.paginator import Paginator
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_POST

from gtm_hit.models import Dataset
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.datasets.listing import dataset_or_404

CHANGES_SHOWN = 20
ROWS_PER_PAGE = 100
WORDS = {
    Role.ANNOTATOR: gettext_lazy("does the batches handed out, and sees nothing else"),
    Role.REVIEWER: gettext_lazy("sees the dataset, looks at workers' batches and decides about them"),
    Role.MANAGER: gettext_lazy("hands out and pays, knows the hidden truth, exports; reviews, too"),
    Role.MAINTAINER: gettext_lazy("imports, calibrates, exports, releases"),
    Role.ADMINISTRATOR: gettext_lazy("everything, and gives roles"),
}


class RoleForm(forms.Form):
    user = forms.CharField(label=gettext_lazy("User name"), max_length=150)
    role = forms.ChoiceField(label=gettext_lazy("Role"), choices=Role.choices)


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@needs(Role.ADMINISTRATOR, everywhere=True)
def people(request: StaffRequest) -> HttpResponse:
    return answered(request, None, "staff/people.html", {"section": "people"})


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@needs(Role.ADMINISTRATOR)
def dataset_people(request: StaffRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    context = {
        "section": "datasets",
        "tab": "people",
        "dataset": dataset,
        "everywhere": granting.holdings(None),
    }
    return answered(request, dataset, "staff/dataset_people.html", context)


def answered(
    request: StaffRequest, dataset: Dataset | None, template: str, context: dict[str, Any]
) -> HttpResponse:
    form = RoleForm(request.POST or None)
    if request.method == "POST" and form.is_valid() and given(request, form, dataset):
        return redirect(request.path)
    found = {
        "form": form,
        "words": WORDS.items(),
        "page": Paginator(granting.holdings(dataset), ROWS_PER_PAGE).get_page(request.GET.get("page")),
        "changes": granting.changes(dataset)[:CHANGES_SHOWN],
    }
    return render(request, template, {**context, **found})


def given(request: StaffRequest, form: RoleForm, dataset: Dataset | None) -> bool:
    """With a message; False with the form's errors."""
    role = Role(form.cleaned_data["role"])
    try:
        user = granting.user_named(form.cleaned_data["user"])
        new = granting.grant(user, role, dataset, request.user)
    except granting.RoleError as error:
        form.add_error("user", str(error))
        return False
    text = _("%(user)s has the role %(role)s now.") if new else _("%(user)s has the role %(role)s already.")
    messages.success(request, text % {"user": user.get_username(), "role": role.label})
    return True


@require_POST
@needs(Role.ADMINISTRATOR, everywhere=True)
def take(request: StaffRequest) -> HttpResponse:
    taken(request, None)
    return redirect("people")


@require_POST
@needs(Role.ADMINISTRATOR)
def take_in_dataset(request: StaffRequest, slug: str) -> HttpResponse:
    taken(request, dataset_or_404(slug))
    return redirect("dataset-people", slug=slug)


def taken(request: StaffRequest, dataset: Dataset | None) -> None:
    form = RoleForm(request.POST)
    if not form.is_valid():
        messages.error(request, _("Say whose role and which."))
        return
    role = Role(form.cleaned_data["role"])
    try:
        user = granting.user_named(form.cleaned_data["user"])
        had = granting.revoke(user, role, dataset, request.user)
    except granting.RoleError as error:
        messages.error(request, str(error))
        return
    text = _("%(user)s no longer has the role %(role)s.") if had else _("%(user)s had no role %(role)s here.")
    messages.success(request, text % {"user": user.get_username(), "role": role.label})


urlpatterns = [
    path("people/", people, name="people"),
    path("people/take/", take, name="people-take"),
    path("datasets/<slug:slug>/people/", dataset_people, name="dataset-people"),
    path("datasets/<slug:slug>/people/take/", take_in_dataset, name="dataset-people-take"),
]
