from __future__ import annotations

from django.contrib import messages
from django.core.paginator import Paginator
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import path
from django.views.decorators.http import require_POST, require_safe

from gtm_hit.ops import overview
from gtm_hit.ops.access.roles import CARES, SEES, layers_of, readable
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.exports.formats.registry import DEFAULT_FORMATS, FORMATS
from gtm_hit.ops.frames import parts
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.datasets.listing import dataset_or_404

ROWS_PER_PAGE = 100


@require_safe
@needs(SEES)
def dataset_layers(request: HttpRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    frames = dataset.frames.count()
    pages = Paginator(overview.layers(dataset).filter(readable(request.user)), ROWS_PER_PAGE)
    context = {
        "section": "datasets",
        "tab": "layers",
        "dataset": dataset,
        "frames": frames,
        "long": parts.is_long(frames),
        "page": pages.get_page(request.GET.get("page")),
        "formats": FORMATS,
        "default_formats": DEFAULT_FORMATS,
    }
    return render(request, "staff/layers.html", context)


@require_POST
@needs(CARES)
def export_layer(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    layer = get_object_or_404(
        layers_of(request.user).select_related("dataset"), dataset__slug=slug, name=name
    )
    formats = request.POST.getlist("format") or DEFAULT_FORMATS
    try:
        return redirect("job", pk=exporting.start(layer, request.user, formats).pk)
    except ValueError as error:
        messages.error(request, str(error))
        return redirect("dataset-layers", slug)


urlpatterns = [
    path("datasets/<slug:slug>/layers/", dataset_layers, name="dataset-layers"),
    path("datasets/<slug:slug>/layers/<str:name>/export/", export_layer, name="export-layer"),
]
