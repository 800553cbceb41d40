"""Programs that look for people: runs, what they found, and who is missing in a layer."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.http import Http404, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.http import require_http_methods, require_POST

from gtm_hit.models import Dataset, Job, Layer, ProposalRun
from gtm_hit.ops import overview
from gtm_hit.ops.access.roles import Role, layers_of
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.frames.rules import MAX_PERSON
from gtm_hit.ops.proposals import crops, detectors, job, layers, missing, runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.work import assignments
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.datasets.listing import dataset_or_404

JOBS_SHOWN = 5
PLACES_SHOWN = 8


def method_choices() -> list[tuple[str, str]]:
    return [(method, str(ProposalRun.Method(method).label)) for method in job.METHODS]


def detector_choices() -> list[tuple[str, str]]:
    named = {
        detectors.BUILT_IN: _("the built-in one, on this server"),
        detectors.NONE: _("none: the background alone"),
    }
    return [(name, named.get(name) or _detector_title(name)) for name in detectors.choices()]


def _detector_title(name: str) -> str:
    if name.startswith(detectors.PLUGIN):
        return _("%(name)s, installed on this server") % {"name": name.removeprefix(detectors.PLUGIN)}
    return _("%(address)s: pictures are sent there") % {"address": name}


class ProposeForm(forms.Form):
    method = forms.ChoiceField(label=gettext_lazy("Method"), choices=method_choices)
    detector = forms.ChoiceField(label=gettext_lazy("Detector"), choices=detector_choices)
    use = forms.BooleanField(
        label=gettext_lazy("Show these people to annotators"), required=False, initial=True
    )


class DecisionForm(forms.Form):
    decision = forms.ChoiceField(choices=[("place", ""), ("nobody", "")])
    frame = forms.IntegerField(min_value=0, max_value=MAX_PERSON)
    position = forms.IntegerField(min_value=0, max_value=MAX_PERSON)
    person = forms.IntegerField(min_value=0, max_value=MAX_PERSON, required=False)


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MAINTAINER)
def dataset_proposals(request: StaffRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    form = ProposeForm(request.POST or None)
    if request.method == "POST" and form.is_valid():
        try:
            return redirect("job", pk=job.start(dataset, job.Order(**form.cleaned_data), request.user).pk)
        except ProposalError as error:
            form.add_error(None, str(error))
    under_way = overview.jobs().filter(dataset=dataset, kind=Job.Kind.PROPOSE).exclude(state=Job.State.DONE)
    context = {
        "section": "datasets",
        "tab": "proposals",
        "dataset": dataset,
        "form": form,
        "runs": runs.summaries(dataset),
        "frames": dataset.frames.count(),
        "jobs": under_way[:JOBS_SHOWN],
        "addresses": detectors.addresses(),
    }
    return render(request, "staff/proposals.html", context)


@require_POST
@needs(Role.MAINTAINER)
def change_run(request: StaffRequest, slug: str, number: int) -> HttpResponse:
    dataset = dataset_or_404(slug)
    run = runs.run_of(dataset, number)
    if run is None:
        raise Http404
    try:
        done = _change(run, request.POST.get("do", ""), request.POST.get("layer", "").strip())
        if done:
            messages.success(request, done)
    except ProposalError as error:
        messages.error(request, str(error))
    return redirect("dataset-proposals", slug=slug)


def _change(run: ProposalRun, wanted: str, layer: str) -> str:
    """What was done, in words; nothing for what nobody can ask for."""
    if wanted == "use":
        runs.use(run)
        return _("Annotators see the people of this run now.")
    if wanted == "hide":
        runs.use_none(run.dataset)
        return _("Annotators see no proposals now.")
    if wanted == "layer":
        made = layers.make_layer(run, layer)
        return _("The layer %(name)s was made.") % {"name": made.name}
    if wanted == "remove":
        runs.remove(run)
        return _("The run and everybody it proposed are gone.")
    return ""


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.REVIEWER)
def layer_missing(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    layer = layers_of(request.user).select_related("dataset").filter(dataset=dataset, name=name).first()
    if layer is None:
        raise Http404
    if request.method == "POST":
        _decide(request, layer)
        return redirect("layer-missing", slug=slug, name=name)
    return render(request, "staff/missing.html", _missing_context(dataset, layer))


def _missing_context(dataset: Dataset, layer: Layer) -> dict[str, Any]:
    report = missing.missing(layer)
    shown = report.places[:PLACES_SHOWN]
    return {
        "section": "datasets",
        "tab": "layers",
        "dataset": dataset,
        "layer": layer,
        "report": report,
        "places": list(zip(shown, crops.crops(dataset, shown), strict=True)),
        "editable": layer.kind != Layer.Kind.ASSIGNMENT,
    }


def _decide(request: StaffRequest, layer: Layer) -> None:
    form = DecisionForm(request.POST)
    if not form.is_valid():
        return messages.error(request, _("That could not be understood; nothing was changed."))
    wanted = form.cleaned_data
    where = (layer, wanted["frame"], wanted["position"])
    try:
        if wanted["decision"] == "place":
            person = missing.place(*where, wanted["person"], request.user)
            messages.success(request, _("Person %(person)d was placed.") % {"person": person})
        else:
            missing.dismiss(*where, request.user)
    except assignments.ReadOnly as error:
        messages.error(request, assignments.explained(error.reason))
    except OperationError as error:
        messages.error(request, str(error))


urlpatterns = [
    path("datasets/<slug:slug>/proposals/", dataset_proposals, name="dataset-proposals"),
    path("datasets/<slug:slug>/proposals/<int:number>/", change_run, name="proposal-run"),
    path("datasets/<slug:slug>/layers/<str:name>/missing/", layer_missing, name="layer-missing"),
]
