"""Numbered exports that never change."""

from __future__ import annotations

from django import forms
from django.core.paginator import Paginator
from django.http import FileResponse, Http404, HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import path
from django.utils.safestring import mark_safe
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.http import require_http_methods, require_safe

from gtm_hit.models import Job, Layer, Release
from gtm_hit.ops.access.jobs import jobs_of
from gtm_hit.ops.access.roles import SEES, Role, layers_of
from gtm_hit.ops.exports.formats.registry import FORMATS
from gtm_hit.ops.quality.statistics.figures import FIGURES
from gtm_hit.ops.releases import releasing
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.datasets.listing import dataset_or_404

ROWS_PER_PAGE = 50
FILES_SHOWN = 200
JOBS_SHOWN = 5


class ReleaseForm(forms.Form):
    layer = forms.ModelChoiceField(
        label=gettext_lazy("Layer"), queryset=Layer.objects.none(), to_field_name="name", empty_label=None
    )
    title = forms.CharField(label=gettext_lazy("Title"), max_length=200, required=False)
    licence = forms.CharField(
        label=gettext_lazy("Licence text"),
        max_length=releasing.MOST_LICENCE,
        widget=forms.Textarea(attrs={"rows": 8}),
    )
    formats = forms.MultipleChoiceField(
        label=gettext_lazy("Formats"),
        choices=[(name, each.label) for name, each in FORMATS.items()],
        widget=forms.CheckboxSelectMultiple,
        initial=releasing.FORMATS,
    )

    def __init__(self, layers: object, *args: object, **kwargs: object) -> None:
        super().__init__(*args, **kwargs)  # type: ignore[arg-type]
        self.fields["layer"].queryset = layers  # type: ignore[attr-defined]


@require_http_methods(["GET", "HEAD", "POST"])
@needs(SEES, write=Role.MAINTAINER)
def dataset_releases(request: StaffRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    layers = layers_of(request.user).select_related("dataset").filter(dataset=dataset).order_by("name")
    layers = layers.filter(layer_frames__revision__gte=1).distinct()
    truth = layers.filter(kind=Layer.Kind.GROUND_TRUTH).first()
    form = ReleaseForm(layers, request.POST or None, initial={"layer": truth.name if truth else None})
    if request.method == "POST" and form.is_valid():
        chosen = form.cleaned_data
        order = releasing.Order(
            chosen["layer"], chosen["licence"], chosen["title"], chosen["formats"], request.user
        )
        try:
            return redirect("job", pk=releasing.start(order).pk)
        except releasing.ReleaseError as error:
            form.add_error(None, str(error))
    page = Paginator(
        releasing.releases(dataset).filter(layer__in=layers_of(request.user)), ROWS_PER_PAGE
    ).get_page(request.GET.get("page"))
    made = jobs_of(request.user).filter(dataset=dataset, kind=Job.Kind.MAKE_RELEASE)
    context = {
        "section": "datasets",
        "tab": "releases",
        "dataset": dataset,
        "form": form,
        "layers": layers.exists(),
        "page": page,
        "jobs": made.exclude(state=Job.State.DONE)[:JOBS_SHOWN],
    }
    return render(request, "staff/releases.html", context)


@require_safe
@needs(SEES)
def release(request: HttpRequest, slug: str, number: int) -> HttpResponse:
    found = _release_or_404(request, slug, number)
    files = sorted(found.manifest["files"].items())
    archive = releasing.archive_of(found)
    context = {
        "section": "datasets",
        "tab": "releases",
        "dataset": found.dataset,
        "release": found,
        "counts": found.manifest["counts"],
        "parameters": found.manifest["parameters"],
        "licence": releasing.text_of(found, "LICENSE"),
        # Drawn by our own figures, so they may be part of the page and follow its colours.
        "figures": [mark_safe(drawn) for name in FIGURES if (drawn := releasing.figure_of(found, name))],
        "archive_bytes": archive.stat().st_size if archive.is_file() else None,
        "files": files[:FILES_SHOWN],
        "more_files": max(len(files) - FILES_SHOWN, 0),
        "file_count": len(files),
    }
    return render(request, "staff/release.html", context)


@require_safe
@needs(SEES)
def download(request: HttpRequest, slug: str, number: int) -> HttpResponse | FileResponse:
    archive = releasing.archive_of(_release_or_404(request, slug, number))
    if not archive.is_file():
        raise Http404(_("The files of this release are not on this server."))
    return FileResponse(archive.open("rb"), as_attachment=True, filename=archive.name)


@require_safe
@needs(SEES)
def part(request: HttpRequest, slug: str, number: int, name: str) -> HttpResponse | FileResponse:
    """One of the few files worth having without the archive."""
    found = _release_or_404(request, slug, number)
    kept = releasing.part_of(found, name)
    if kept is None:
        raise Http404(_("This release has no such file on this server."))
    return FileResponse(kept.open("rb"), as_attachment=True, filename=name)


def _release_or_404(request: HttpRequest, slug: str, number: int) -> Release:
    found = Release.objects.filter(layer__in=layers_of(request.user))
    found = found.select_related("dataset", "layer", "created_by")
    return get_object_or_404(found, dataset__slug=slug, number=number)


urlpatterns = [
    path("datasets/<slug:slug>/releases/", dataset_releases, name="dataset-releases"),
    path("datasets/<slug:slug>/releases/<int:number>/", release, name="release"),
    path("datasets/<slug:slug>/releases/<int:number>/download/", download, name="release-download"),
    path("datasets/<slug:slug>/releases/<int:number>/<str:name>", part, name="release-part"),
]
