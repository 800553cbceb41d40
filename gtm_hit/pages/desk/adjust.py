"""All cameras and points of a desk adjusted at once; what came of it, and what is made of that."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_POST, require_safe

from gtm_hit.models import Desk
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import (
    adjust_choices,
    adjust_decisions,
    adjust_files,
    adjust_job,
    adjust_results,
    adjust_view,
    edits,
)
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.uploads import takes_uploads
from gtm_hit.pages.desk.common import desk_or_404, frame, tried
from gtm_hit.pages.desk.ground import UNITS

DECISIONS = [("keep", gettext_lazy("Keep")), ("drop", gettext_lazy("Drop"))]
CLICK = ("source", "point", "camera", "decision")


class AdjustForm(forms.Form):
    variant = forms.ChoiceField(label=gettext_lazy("Lenses"), choices=adjust_choices.VARIANTS)
    turn = forms.FloatField(label=gettext_lazy("A miss counts less from, px"), min_value=0.01)
    ground_weight = forms.FloatField(
        label=gettext_lazy("Weight of a measured point's click"),
        required=False,
        min_value=0,
        help_text=gettext_lazy("Empty: together as much as all others"),
    )
    ground_sigma = forms.FloatField(label=gettext_lazy("Measured points may be off by, cm"), min_value=0)
    hold = forms.CharField(
        label=gettext_lazy("Held as it is"),
        required=False,
        help_text=gettext_lazy("Camera and pose, lens or its numbers: C1:pose C3:fx,k3"),
    )

    def choices(self) -> Choices:
        """Raises DeskError."""
        given = self.cleaned_data
        return Choices(
            given["variant"],
            given["turn"],
            given["ground_weight"],
            given["ground_sigma"] / 100,
            adjust_choices.holding(given["hold"].split()),
        )


class ClickFileForm(forms.Form):
    file = forms.FileField(label=gettext_lazy("A zip of CAMERA/FRAME.pos, or a ba_problem.txt"))
    unit = forms.ChoiceField(label=gettext_lazy("Unit of a ba_problem.txt"), choices=UNITS[1:], initial="cm")


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@needs(Role.MAINTAINER)
def desk_adjust(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    form = AdjustForm(request.POST or None, initial=_initial(adjust_view.last_choices(found)))
    if request.method == "POST" and form.is_valid():
        try:
            adjust_job.start(found, form.choices(), request.user)
            return redirect("desk-adjust", desk=desk)
        except DeskError as error:
            form.add_error(None, str(error))
    return render(request, "desk/adjust.html", _context(request, found, form))


@require_POST
@needs(Role.MAINTAINER)
def change_adjust(request: StaffRequest, desk: str, what: str) -> HttpResponse:
    found, given, user = desk_or_404(request, desk), request.POST, request.user
    number = given.get("number", "")

    def decide() -> None:
        source, point, camera, decision = (given.get(name, "") for name in CLICK)
        adjust_decisions.decide(found, source, point, camera, decision, user)

    operations = {
        "undo": lambda: edits.undo(found, adjust_results.PAGE),
        "redo": lambda: edits.redo(found, adjust_results.PAGE),
        "use": lambda: adjust_results.use(found, int(number) if number.isdecimal() else None, user),
        "back": lambda: adjust_results.go_back(found, user),
        "decide": decide,
        "leave-out": lambda: adjust_files.stop_using(found, given.get("digest", ""), user),
    }
    if what in operations:
        tried(request, operations[what])
    answer = redirect("desk-adjust", desk=desk)
    if number.isdecimal():
        answer["Location"] += f"?result={number}"
    if what == "decide":
        answer["Location"] += "#worst"
    return answer


@require_POST
@takes_uploads(Role.MAINTAINER)
def put_click_file(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    form = ClickFileForm(request.POST, request.FILES)
    if form.is_valid():
        file, unit = form.cleaned_data["file"], form.cleaned_data["unit"]
        tried(
            request,
            lambda: adjust_files.put_any(found, file.read(), file.name, unit, user=request.user),
            _("The clicks of the file are adjusted with."),
        )
    for name, errors in form.errors.items():
        messages.error(request, f"{form[name].label}: {' '.join(map(str, errors))}")
    return redirect("desk-adjust", desk=desk)


@require_safe
@needs(Role.MAINTAINER)
def problem_file(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    try:
        text = adjust_files.problem_text(found, adjust_view.last_choices(found))
    except DeskError as error:
        messages.error(request, str(error))
        return redirect("desk-adjust", desk=desk)
    answer = HttpResponse(text, content_type="text/plain")
    answer["Content-Disposition"] = 'attachment; filename="ba_problem.txt"'
    return answer


@require_safe
@needs(Role.MAINTAINER)
def pos_files(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    try:
        data = adjust_files.pos_zip(found)
    except DeskError as error:
        messages.error(request, str(error))
        return redirect("desk-adjust", desk=desk)
    answer = HttpResponse(data, content_type="application/zip")
    answer["Content-Disposition"] = f'attachment; filename="{desk}-pos.zip"'
    return answer


def _context(request: StaffRequest, desk: Desk, form: AdjustForm) -> dict[str, Any]:
    told = adjust_view.whole(desk)
    wanted = request.GET.get("result", "")
    number = int(wanted) if wanted.isdecimal() else None
    try:
        result = adjust_results.result_of(desk, number)
    except NotThere:
        result = None
    report = result.report if result else None
    shared = told["shared"]
    return {
        **frame(desk, "adjust"),
        **told,
        "form": form,
        "file_form": ClickFileForm(),
        "job": adjust_job.jobs_of(desk).first(),
        "matrix": _matrix(shared),
        "names": shared["cameras"],
        "free": shared["free"],
        "result": result,
        "report": report,
        "rows": [_row(each) for each in report["cameras"]] if report else [],
        "feet_cm": 100 * report["feet"]["median"] if report and report["feet"] else None,
        "decisions": DECISIONS,
        "worst": adjust_view.worst(desk, result) if result else [],
        "since": adjust_results.changes(desk, result) if result else [],
    }


def _matrix(shared: dict[str, Any]) -> list[dict[str, Any]]:
    rows = zip(shared["cameras"], shared["points"], shared["measured"], strict=True)
    return [
        {
            "name": name,
            "cells": [{"count": count, "self": place == number} for place, count in enumerate(counts)],
            "measured": measured,
        }
        for number, (name, counts, measured) in enumerate(rows)
    ]


def _row(camera: dict[str, Any]) -> dict[str, Any]:
    """Lengths as the page speaks of them: centimetres."""
    sigma = camera["centre_sigma"]
    return {
        **camera,
        "moved_cm": 100 * camera["moved"],
        "sigma_cm": None if sigma is None else 100 * sigma,
        "far": adjust_view.far_shifts(camera),
        "farthest": adjust_view.farthest_shift(camera),
    }


def _initial(choices: Choices) -> dict[str, Any]:
    return {
        "variant": choices.variant,
        "turn": choices.turn,
        "ground_weight": choices.ground_weight,
        "ground_sigma": round(100 * choices.ground_sigma, 6),
        "hold": " ".join(choices.hold),
    }


AT = "calibration-desks/<slug:desk>/adjust/"

urlpatterns = [
    path(AT, desk_adjust, name="desk-adjust"),
    path(f"{AT}files/", put_click_file, name="desk-click-file"),
    path(f"{AT}ba_problem.txt", problem_file, name="desk-ba-problem"),
    path(f"{AT}pos.zip", pos_files, name="desk-pos"),
    path(f"{AT}<slug:what>/", change_adjust, name="desk-change-adjust"),
]
