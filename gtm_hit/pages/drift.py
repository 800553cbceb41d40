"""Whether the cameras of a dataset still stand as they were calibrated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django import forms
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.http import require_http_methods

from gtm_hit.models import Dataset, DriftCheck, Job
from gtm_hit.ops import overview
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.drift import job, remembering
from gtm_hit.ops.drift.checking import WARN
from gtm_hit.ops.drift.pictures import DriftRefused, Span
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.datasets.listing import dataset_or_404

JOBS_SHOWN, CHECKS_SHOWN = 5, 10
MOST_FRAME = 2**31 - 1
PLOT = (160, 32)  # units of a small plot
AT_LEAST = 2 * WARN  # pixels at its top
LONGER = 12  # times; an arrow of its true length would be a dot


class SpanForm(forms.Form):
    first = forms.IntegerField(
        label=gettext_lazy("From frame"), required=False, min_value=0, max_value=MOST_FRAME
    )
    last = forms.IntegerField(
        label=gettext_lazy("To frame"), required=False, min_value=0, max_value=MOST_FRAME
    )
    every = forms.IntegerField(label=gettext_lazy("Every n-th"), initial=1, min_value=1, max_value=MOST_FRAME)

    def clean(self) -> dict[str, Any]:
        given = self.cleaned_data
        first, last = given.get("first"), given.get("last")
        if first is not None and last is not None and first > last:
            raise forms.ValidationError(_("The last frame comes before the first."))
        return given


@dataclass(frozen=True)
class Plot:
    """How far a camera was off, frame by frame; frames that tell nothing break the line."""

    lines: list[str]
    dots: list[tuple[float, float]]
    warn: float  # height of the line above which is warned
    most: float  # pixels at the top


@dataclass(frozen=True)
class CameraDrift:
    facts: dict[str, Any]
    width: int
    height: int
    plot: Plot
    arrows: list[tuple[float, float, float, float]]  # x1, y1, x2, y2


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MAINTAINER)
def dataset_drift(request: StaffRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    form = SpanForm(request.POST or None)
    if request.method == "POST" and form.is_valid():
        remember = request.POST.get("do") == "remember"
        try:
            return redirect(
                "job", pk=job.start(dataset, Span(**form.cleaned_data), remember, request.user).pk
            )
        except DriftRefused as error:
            form.add_error(None, str(error))
    checks = list(dataset.drift_checks.select_related("calibration", "created_by")[:CHECKS_SHOWN])
    shown = next((check for check in checks if str(check.pk) == request.GET.get("check")), None)
    shown = shown or (checks[0] if checks else None)
    jobs = overview.jobs().filter(dataset=dataset, kind=Job.Kind.DRIFT).exclude(state=Job.State.DONE)
    context = {
        "section": "datasets",
        "tab": "calibration",
        "dataset": dataset,
        "form": form,
        "remembered": list(remembering.remembered(dataset)),
        "checks": checks,
        "check": shown,
        "cameras": _cameras(dataset, shown) if shown else [],
        "warn": WARN,
        "longer": LONGER,
        "plot_size": PLOT,
        "jobs": jobs[:JOBS_SHOWN],
    }
    return render(request, "staff/imports/drift.html", context)


def _cameras(dataset: Dataset, check: DriftCheck) -> list[CameraDrift]:
    sizes = {row.name: (row.width, row.height) for row in dataset.cameras.all()}
    return [
        CameraDrift(facts, *sizes[facts["camera"]], _plot(facts["series"]), _arrows(facts["arrows"]))
        for facts in check.cameras
        if facts["camera"] in sizes
    ]


def _arrows(moved: list[list[float]]) -> list[tuple[float, float, float, float]]:
    return [(x, y, x + LONGER * dx, y + LONGER * dy) for x, y, dx, dy in moved]


def _plot(series: list[list[Any]]) -> Plot:
    width, height = PLOT
    most = max([AT_LEAST, *[px for _frame, px, _cm in series if px is not None]])
    runs: list[list[tuple[float, float]]] = [[]]
    for index, (_frame, px, _cm) in enumerate(series):
        if px is None:
            runs.append([])
            continue
        runs[-1].append((round(width * (index + 0.5) / len(series), 1), round(height * (1 - px / most), 1)))
    lines = [" ".join(f"{x},{y}" for x, y in run) for run in runs if len(run) > 1]
    dots = [run[0] for run in runs if len(run) == 1]
    return Plot(lines, dots, round(height * (1 - WARN / most), 1), most)


urlpatterns = [path("datasets/<slug:slug>/drift/", dataset_drift, name="dataset-drift")]
