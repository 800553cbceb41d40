"""Measured points and where each camera sees them."""

from __future__ import annotations

from collections.abc import Callable

from django import forms
from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path, reverse
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_POST, require_safe

from gtm_hit.models import Desk
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import ground, pictures
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.uploads import takes_uploads
from gtm_hit.pages.desk.common import desk_or_404, frame, tried

UNITS = [
    ("", gettext_lazy("the file says")),
    ("m", gettext_lazy("metres")),
    ("cm", gettext_lazy("centimetres")),
    ("mm", gettext_lazy("millimetres")),
]


class PointsForm(forms.Form):
    file = forms.FileField(label=gettext_lazy("CSV or JSON"))
    unit = forms.ChoiceField(label=gettext_lazy("Unit"), choices=UNITS, required=False)


class GridForm(forms.Form):
    columns = forms.IntegerField(label=gettext_lazy("Columns, along X"), min_value=1, max_value=1000)
    rows = forms.IntegerField(label=gettext_lazy("Rows, along Y"), min_value=1, max_value=1000)
    spacing_x = forms.FloatField(label=gettext_lazy("Between columns, m"))
    spacing_y = forms.FloatField(label=gettext_lazy("Between rows, m"))
    origin_x = forms.FloatField(label=gettext_lazy("X of the first, m"), initial=0)
    origin_y = forms.FloatField(label=gettext_lazy("Y of the first, m"), initial=0)


class PictureForm(forms.Form):
    camera = forms.CharField(max_length=80, widget=forms.HiddenInput)
    file = forms.FileField(label=gettext_lazy("PNG or JPEG, as it was taken"), required=False)
    frame = forms.IntegerField(label=gettext_lazy("or frame number"), min_value=0, required=False)


class ClicksForm(forms.Form):
    camera = forms.CharField(max_length=80, widget=forms.HiddenInput)
    file = forms.FileField(label=gettext_lazy("JSON"))
    unit = forms.ChoiceField(label=gettext_lazy("Unit of its points"), choices=UNITS, required=False)


@require_safe
@never_cache
@needs(Role.MAINTAINER)
def desk_ground(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    around = frame(found, "ground")
    context = {
        **around,
        "ground": {
            "api": around["api"],
            "ground": ground.whole(found),
            "camera": request.GET.get("camera", ""),
        },
        "points_form": PointsForm(),
        "grid_form": GridForm(),
        "picture_form": PictureForm(),
        "clicks_form": ClicksForm(),
        "points": found.points.count(),
    }
    return render(request, "desk/ground.html", context)


@require_POST
@takes_uploads(Role.MAINTAINER)
def put_points(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    form = PointsForm(request.POST, request.FILES)

    def put() -> None:
        file = form.cleaned_data["file"]
        ground.put_file(found, file.read(), file.name, form.cleaned_data["unit"], request.user)

    return _done(request, found, form, put, _("The points are those of the file now."))


@require_POST
@needs(Role.MAINTAINER)
def put_grid(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    form = GridForm(request.POST)

    def put() -> None:
        given = form.cleaned_data
        spacing, origin = ((given[f"{name}_x"], given[f"{name}_y"]) for name in ("spacing", "origin"))
        ground.put_grid(found, given["columns"], given["rows"], spacing, origin, request.user)

    return _done(request, found, form, put, _("The points are those of the grid now."))


@require_POST
@takes_uploads(Role.MAINTAINER)
def put_picture(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    form = PictureForm(request.POST, request.FILES)

    def put() -> None:
        given = form.cleaned_data
        if given["file"]:
            pictures.put(found, given["camera"], given["file"].read(), request.user)
        elif given["frame"] is not None:
            pictures.put_frame(found, given["camera"], given["frame"], request.user)

    return _done(request, found, form, put, "")


@require_POST
@takes_uploads(Role.MAINTAINER)
def put_clicks(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    form = ClicksForm(request.POST, request.FILES)

    def put() -> None:
        given = form.cleaned_data
        file = given["file"]
        ground.put_pairs(found, given["camera"], file.read(), file.name, given["unit"], request.user)

    return _done(request, found, form, put, _("The clicks of the file are there."))


def _done(
    request: StaffRequest, desk: Desk, form: forms.Form, put: Callable[[], object], words: str
) -> HttpResponse:
    """Back to the page, at the camera it was about."""
    if form.is_valid():
        tried(request, put, words)
    else:
        for name, errors in form.errors.items():
            messages.error(request, f"{form[name].label}: {' '.join(map(str, errors))}")
    camera = str(form.data.get("camera", ""))
    address = reverse("desk-ground", args=[desk.slug])
    return redirect(f"{address}?camera={camera}" if desk.cameras.filter(name=camera).exists() else address)


urlpatterns = [
    path("calibration-desks/<slug:desk>/ground/", desk_ground, name="desk-ground"),
    path("calibration-desks/<slug:desk>/ground/points/", put_points, name="desk-points"),
    path("calibration-desks/<slug:desk>/ground/grid/", put_grid, name="desk-grid"),
    path("calibration-desks/<slug:desk>/ground/picture/", put_picture, name="desk-picture-form"),
    path("calibration-desks/<slug:desk>/ground/clicks/", put_clicks, name="desk-clicks"),
]
