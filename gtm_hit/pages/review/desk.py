"""One assignment at the desk, the corrected copy of it, and the decision on an appeal."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django import forms
from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import get_script_prefix, path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_POST, require_safe

from gtm_hit.models import Appeal, Category, Mend
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.review import facts, mending, needs, queue
from gtm_hit.ops.review.actors import own_work
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.refusals import ReviewRefused
from gtm_hit.ops.review.transitions import transition
from gtm_hit.pages.common.access import StaffRequest
from gtm_hit.pages.common.access import needs as needs_role
from gtm_hit.pages.review.scopes import address, assignment_or_404, scope_or_404
from gtm_hit.pages.work.workplace import api, workbench


class AppealForm(forms.Form):
    reason = forms.CharField(
        label=gettext_lazy("Your answer; the worker reads it"),
        max_length=needs.MOST_LETTERS,
        widget=forms.Textarea(attrs={"rows": 4}),
    )


@require_safe
@never_cache
@needs_role(Role.REVIEWER)
def desk(request: StaffRequest, slug: str, pk: int, name: str | None = None) -> HttpResponse:
    scope = scope_or_404(slug, name)
    assignment = assignment_or_404(scope, pk)
    told = facts.whole(assignment)
    context = {
        "dataset": scope.dataset,
        "assignment": assignment,
        "desk": {
            **{key: told[key] for key in ("state", "worker", "why", "suspicion", "reasons", "comments")},
            "batch": str(assignment.batch),
            "steps": told["steps"],
            "mended": told["mended"],
            "mine": bool(told["mended"]) and told["mended"]["by"] == request.user.get_username(),
            "own": own_work(request.user, assignment.worker),
            "scene": f"{get_script_prefix()}api/v1/layers/{assignment.layer_id}/",
            "api": f"{get_script_prefix()}api/v1/datasets/{slug}/reviews/{pk}/",
            "home": address(scope),
            "desk": address(scope, "desk", 0),  # of another one, with its number for 0
            "mend": address(scope, "mend", pk),
            "appeal": address(scope, "appeal", pk) if waits_for_appeal(told) else "",
            "categories": [[value, str(label)] for value, label in Category.choices],
            "least": needs.least_letters(assignment),
        },
    }
    return render(request, "review/desk.html", context)


def waits_for_appeal(told: dict[str, Any]) -> bool:
    return bool(told["appeal"]) and told["appeal"]["outcome"] == Appeal.Outcome.OPEN


@require_POST
@needs_role(Role.REVIEWER)
def mend(request: StaffRequest, slug: str, pk: int, name: str | None = None) -> HttpResponse:
    scope = scope_or_404(slug, name)
    try:
        mending.mend(assignment_or_404(scope, pk), request.user)
    except ReviewRefused as error:
        messages.error(request, str(error))
        return redirect(address(scope))
    return redirect(address(scope, "mended", pk))


@require_safe
@never_cache
@needs_role(Role.REVIEWER)
def mended(request: StaffRequest, slug: str, pk: int, name: str | None = None) -> HttpResponse:
    scope = scope_or_404(slug, name)
    made = get_object_or_404(Mend, assignment=assignment_or_404(scope, pk))
    home = address(scope, "desk", pk)
    return workbench(request, api=api(f"layers/{made.layer_id}/"), token="", mode="layer", home=home)


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@needs_role(Role.REVIEWER)
def appeal(request: StaffRequest, slug: str, pk: int, name: str | None = None) -> HttpResponse:
    scope = scope_or_404(slug, name)
    assignment = assignment_or_404(scope, pk)
    made = get_object_or_404(Appeal.objects.select_related("decided_by"), assignment=assignment)
    form = AppealForm(request.POST or None)
    problem = ""
    if request.method == "POST" and form.is_valid():
        action = Action.OVERTURN if request.POST.get("decision") == "overturn" else Action.UPHOLD
        try:
            transition(assignment, action, request.user, reason=form.cleaned_data["reason"])
            messages.success(request, _("The appeal is decided."))
            return redirect(address(scope))
        except ReviewRefused as error:
            problem = str(error)
    context: dict[str, Any] = {
        "section": "datasets",
        "tab": "campaigns" if scope.campaign else "review",
        "dataset": scope.dataset,
        "campaign": scope.campaign,
        "assignment": assignment,
        "appeal": made,
        "rejection": queue.rejection(assignment),
        "desk": address(scope, "desk", pk),
        "form": form,
        "problem": problem,
    }
    return render(request, "review/appeal.html", context, status=400 if problem else 200)


def both(view: Callable[..., Any], page: str, tail: str) -> list[Any]:
    """Below the dataset, and below a campaign."""
    return [
        path(f"datasets/<slug:slug>/review/<int:pk>/{tail}", view, name=f"dataset-review-{page}"),
        path(
            f"datasets/<slug:slug>/campaigns/<str:name>/review/<int:pk>/{tail}",
            view,
            name=f"campaign-review-{page}",
        ),
    ]


urlpatterns = [
    *both(desk, "desk", ""),
    *both(mend, "mend", "mend/"),
    *both(mended, "mended", "mended/"),
    *both(appeal, "appeal", "appeal/"),
]
