"""What a paper prints about a dataset, for any of its layers, as figures and as numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode

from django import forms
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import render
from django.urls import path
from django.utils.safestring import mark_safe
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_safe

from gtm_hit.metrics.coverage import Coverage
from gtm_hit.models import Layer
from gtm_hit.ops.access.roles import SEES
from gtm_hit.ops.quality.statistics.figures import FIGURES, figure
from gtm_hit.ops.quality.statistics.files import numbers_csv
from gtm_hit.ops.quality.statistics.measuring import (
    EVERY,
    LayerStatistics,
    ground_coverage,
    layer_statistics,
    unmeasurable,
)
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.common.attachments import attachment, csv_attachment
from gtm_hit.pages.common.layer_choice import LayerChoice
from gtm_hit.pages.datasets.listing import dataset_or_404

STEPS = [1, 2, 4, 8, 16, 32]


class StatisticsForm(forms.Form):
    layer = forms.ChoiceField(label=gettext_lazy("Layer"))
    every = forms.TypedChoiceField(
        label=gettext_lazy("Coverage at every n-th position"),
        choices=[(step, step) for step in STEPS],
        coerce=int,
    )


@dataclass(frozen=True)
class Asked:
    """What an address asks for; `problem` when it cannot be shown."""

    context: dict[str, Any]
    layer: Layer | None
    every: int
    problem: str = ""

    def measured(self) -> tuple[LayerStatistics, Coverage]:
        if self.layer is None:
            raise Http404(self.problem)
        return layer_statistics(self.layer), ground_coverage(self.layer.dataset, self.every)

    @property
    def query(self) -> str:
        return urlencode({"layer": self.layer.name if self.layer else "", "every": self.every})


def asked_for(request: HttpRequest, slug: str) -> Asked:
    dataset = dataset_or_404(slug)
    name = request.GET.get("layer")
    choice = LayerChoice(dataset, request.user, name)
    first = choice.listed[0].name if choice.listed else ""
    form = StatisticsForm({"layer": name or first, "every": request.GET.get("every") or EVERY})
    form.fields["layer"].choices = choice.choices  # type: ignore[attr-defined]
    context = {"section": "datasets", "tab": "statistics", "dataset": dataset, "form": form}
    if not dataset.cameras.exists():
        return Asked(context, None, EVERY, _("This dataset has no cameras."))
    if reason := unmeasurable(dataset):
        return Asked(context, None, EVERY, reason)
    if not choice.listed:
        return Asked(context, None, EVERY, _("This dataset has no layers yet."))
    if not form.is_valid():
        problems = [str(error) for errors in form.errors.values() for error in errors]
        return Asked(context, None, EVERY, " ".join(problems))
    return Asked(context, choice.get(form.cleaned_data["layer"]), form.cleaned_data["every"])


@require_safe
@never_cache
@needs(SEES)
def statistics(request: HttpRequest, slug: str) -> HttpResponse:
    asked = asked_for(request, slug)
    if asked.layer is None:
        context = {**asked.context, "problem": asked.problem}
        return render(request, "staff/statistics.html", context, status=404 if request.GET else 200)
    found, ground = asked.measured()
    context = {
        **asked.context,
        "layer": asked.layer,
        "found": found,
        "ground": ground,
        "query": asked.query,
        # The SVG is ours and escapes every name in it.
        "figures": [(name, mark_safe(figure(name, found, ground))) for name in FIGURES],
        "distributions": distribution_rows(found),
    }
    return render(request, "staff/statistics.html", context)


def distribution_rows(found: LayerStatistics) -> list[tuple[str, str, Any, int]]:
    """Words, unit, distribution, decimals."""
    summary = found.summary
    return [
        (_("People per frame"), "", summary.people_per_frame, 1),
        (_("Track length"), _("frames"), summary.track_annotations, 1),
        (_("Distance walked"), "m", summary.track_path, 2),
        (_("Speed"), "m/s", summary.speed, 2),
        (_("Height"), "m", summary.height, 2),
    ]


@require_safe
@never_cache
@needs(SEES)
def statistics_figure(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    if name not in FIGURES:
        raise Http404(_("There is no figure “%(name)s”.") % {"name": name})
    asked = asked_for(request, slug)
    return attachment(figure(name, *asked.measured()), "image/svg+xml", f"{base_name(asked)}-{name}.svg")


@require_safe
@never_cache
@needs(SEES)
def statistics_csv(request: HttpRequest, slug: str) -> HttpResponse:
    asked = asked_for(request, slug)
    table = numbers_csv(*asked.measured())
    return csv_attachment(table, f"{base_name(asked)}-statistics.csv")


def base_name(asked: Asked) -> str:
    assert asked.layer is not None
    return f"{asked.layer.dataset.slug}-{asked.layer.name}"


urlpatterns = [
    path("datasets/<slug:slug>/statistics/", statistics, name="statistics"),
    path("datasets/<slug:slug>/statistics/numbers.csv", statistics_csv, name="statistics-csv"),
    path("datasets/<slug:slug>/statistics/<slug:name>.svg", statistics_figure, name="statistics-figure"),
]
