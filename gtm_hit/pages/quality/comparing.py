"""Two layers against each other: scores, frames worst first, and a viewer that shows what is wrong where."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode

from django import forms
from django.core.paginator import Paginator
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import render
from django.urls import get_script_prefix, path
from django.utils.safestring import mark_safe
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_safe

from gtm_hit.metrics.figures import score_curve
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.models import Layer
from gtm_hit.ops.access.roles import SEES, Role, may
from gtm_hit.ops.files.csv_text import csv_text
from gtm_hit.ops.quality import agreement
from gtm_hit.ops.quality.comparing import (
    LARGEST_RADIUS,
    MOST_FRAMES,
    Comparison,
    Scope,
    compare,
    frame_lines,
)
from gtm_hit.ops.quality.layer_rows import QualityError
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.common.attachments import attachment, csv_attachment
from gtm_hit.pages.common.layer_choice import LayerChoice
from gtm_hit.pages.datasets.listing import dataset_or_404

FRAMES_PER_PAGE = 50
BATCHES_PER_PAGE = 20


class CompareForm(forms.Form):
    a = forms.ChoiceField(label=gettext_lazy("Truth"))
    b = forms.ChoiceField(label=gettext_lazy("Compared with it"))
    radius = forms.FloatField(
        label=gettext_lazy("Radius, metres"), min_value=0.001, max_value=LARGEST_RADIUS, initial=RADIUS
    )
    frames = forms.ChoiceField(
        label=gettext_lazy("Frames"),
        choices=[
            (Scope.BOTH.value, gettext_lazy("that both have")),
            (Scope.EITHER.value, gettext_lazy("that either has")),
        ],
    )
    start = forms.IntegerField(label=gettext_lazy("From frame"), min_value=0, initial=0)


@dataclass(frozen=True)
class Asked:
    """What an address asks for; no comparison and perhaps a problem when it cannot be shown."""

    context: dict[str, Any]
    sides: tuple[Layer, Layer] | None = None
    comparison: Comparison | None = None
    query: str = ""
    problem: str = ""

    def required(self) -> tuple[tuple[Layer, Layer], Comparison]:
        if self.sides is None or self.comparison is None:
            raise Http404(self.problem or _("Choose two layers."))
        return self.sides, self.comparison


def asked_for(request: HttpRequest, slug: str) -> Asked:
    dataset = dataset_or_404(slug)
    given = {name: request.GET[name] for name in CompareForm.base_fields if request.GET.get(name)}
    choice = LayerChoice(dataset, request.user, given.get("a"), given.get("b"))
    first = [layer.name for layer in choice.listed[:2]]
    usual = dict(zip("ab", first, strict=False)) | {"radius": RADIUS, "frames": Scope.BOTH.value, "start": 0}
    form = CompareForm({**usual, **given})
    for side in "ab":
        form.fields[side].choices = choice.choices  # type: ignore[attr-defined]
    context = {"section": "datasets", "tab": "compare", "dataset": dataset, "form": form}
    if not (given.get("a") and given.get("b")):
        return Asked(context)
    if not form.is_valid():
        problems = [str(error) for errors in form.errors.values() for error in errors]
        return Asked(context, problem=" ".join(problems))
    return compared(context, form.cleaned_data, choice)


def compared(context: dict[str, Any], wanted: dict[str, Any], choice: LayerChoice) -> Asked:
    truth, found = choice.get(wanted["a"]), choice.get(wanted["b"])
    assert truth and found  # the form offers nothing else
    try:
        comparison = compare(
            truth, found, wanted["radius"], Scope(wanted["frames"]), wanted["start"], MOST_FRAMES
        )
    except QualityError as error:
        return Asked(context, problem=str(error))
    return Asked(context, (truth, found), comparison, urlencode(wanted))


@require_safe
@never_cache
@needs(SEES)
def compare_layers(request: HttpRequest, slug: str) -> HttpResponse:
    asked = asked_for(request, slug)
    context = {**asked.context, "problem": asked.problem, **agreements(request, asked)}
    if asked.comparison:
        comparison = asked.comparison
        page = Paginator(frame_lines(comparison), FRAMES_PER_PAGE).get_page(request.GET.get("page"))
        context |= {
            "sides": asked.sides,
            "comparison": comparison,
            "curve": mark_safe(curve(asked)),
            "page": page,
            "query": asked.query,
            "more_from": int(comparison.numbers[-1]) + 1 if comparison.later else None,
        }
    return render(request, "staff/compare.html", context, status=404 if asked.problem else 200)


def agreements(request: HttpRequest, asked: Asked) -> dict[str, Any]:
    dataset = asked.context["dataset"]
    if not may(request.user, Role.REVIEWER, dataset):
        return {}
    pages = Paginator(agreement.shared_batches(dataset), BATCHES_PER_PAGE)
    page = pages.get_page(request.GET.get("batches"))
    numbers = list(page.object_list)
    return {
        "batch_page": page,
        "batches": agreement.batch_agreements(dataset, numbers) if numbers else [],
    }


def curve(asked: Asked) -> str:
    (truth, found), comparison = asked.required()
    title = _("%(found)s against %(truth)s") % {"found": found.name, "truth": truth.name}
    return score_curve(comparison.curve, title=title, marked=comparison.radius)


@require_safe
@never_cache
@needs(SEES)
def compare_curve(request: HttpRequest, slug: str) -> HttpResponse:
    asked = asked_for(request, slug)
    return attachment(curve(asked), "image/svg+xml", f"{base_name(asked)}-curve.svg")


@require_safe
@never_cache
@needs(SEES)
def compare_csv(request: HttpRequest, slug: str) -> HttpResponse:
    asked = asked_for(request, slug)
    lines = frame_lines(asked.required()[1])
    table = csv_text(lines[0] if lines else (), (line.values() for line in lines))
    return csv_attachment(table, f"{base_name(asked)}-frames.csv")


@require_safe
@never_cache
@needs(SEES)
def compare_view(request: HttpRequest, slug: str) -> HttpResponse:
    asked = asked_for(request, slug)
    (truth, found), comparison = asked.required()
    lines = frame_lines(comparison)
    if not lines:
        raise Http404(_("Nobody is in these frames, in either layer."))
    context = {
        "dataset": asked.context["dataset"],
        "query": asked.query,
        "marks": marks_address(asked),
        "viewer": {
            "scene": f"{get_script_prefix()}api/v1/layers/{truth.pk}/",
            "truth": truth.name,
            "found": found.name,
            "frames": lines,
        },
    }
    return render(request, "staff/compare_view.html", context)


def marks_address(asked: Asked) -> str:
    """Where the viewer asks for a frame's marks, with 0 for the frame's number."""
    (truth, found), comparison = asked.required()
    wanted = asked.context["form"].cleaned_data
    query = {"truth": truth.name, "found": found.name, "radius": comparison.radius}
    query |= {"scope": wanted["frames"], "start": wanted["start"]}
    return (
        f"{get_script_prefix()}api/v1/datasets/{truth.dataset.slug}/evaluation/frames/0/?{urlencode(query)}"
    )


def base_name(asked: Asked) -> str:
    truth, found = asked.required()[0]
    return f"{truth.dataset.slug}-{found.name}-against-{truth.name}"


urlpatterns = [
    path("datasets/<slug:slug>/compare/", compare_layers, name="compare"),
    path("datasets/<slug:slug>/compare/view/", compare_view, name="compare-view"),
    path("datasets/<slug:slug>/compare/curve.svg", compare_curve, name="compare-curve"),
    path("datasets/<slug:slug>/compare/frames.csv", compare_csv, name="compare-csv"),
]
