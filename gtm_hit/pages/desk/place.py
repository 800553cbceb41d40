"""Putting a desk's calibration in place, or taking it along as files."""

from __future__ import annotations

from collections.abc import Callable

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_safe

from gtm_hit.models import Desk
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import overview, placing
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.desk.common import desk_or_404, frame


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@needs(Role.MAINTAINER)
def desk_place(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    if request.method == "POST":
        try:
            return redirect("job", pk=placing.compare(found, request.user).pk)
        except DeskError as error:
            messages.error(request, str(error))
            return redirect("desk-place", desk=desk)
    try:
        cameras, problem = placing.cameras(found), ""
    except DeskError as error:
        cameras, problem = [], str(error)
    context = {
        **frame(found, "place"),
        "found": overview.overview(found),
        "centres": [(camera.name, camera.centre.tolist()) for camera in cameras],
        "problem": problem,
        "cautions": placing.cautions(found) if cameras else [],
    }
    return render(request, "desk/place.html", context)


@require_safe
@needs(Role.MAINTAINER)
def cameras_json(request: StaffRequest, desk: str) -> HttpResponse:
    return _file(request, desk, placing.cameras_json, "cameras.json", "application/json")


@require_safe
@needs(Role.MAINTAINER)
def calibrations_zip(request: StaffRequest, desk: str) -> HttpResponse:
    return _file(request, desk, placing.folder_zip, f"{desk}-calibrations.zip", "application/zip")


def _file(
    request: StaffRequest, slug: str, made: Callable[[Desk], bytes], name: str, kind: str
) -> HttpResponse:
    try:
        answer = HttpResponse(made(desk_or_404(request, slug)), content_type=kind)
    except DeskError as error:
        messages.error(request, str(error))
        return redirect("desk-place", desk=slug)
    answer["Content-Disposition"] = f'attachment; filename="{name}"'
    return answer


urlpatterns = [
    path("calibration-desks/<slug:desk>/place/", desk_place, name="desk-place"),
    path("calibration-desks/<slug:desk>/place/cameras.json", cameras_json, name="desk-cameras-json"),
    path("calibration-desks/<slug:desk>/place/calibrations.zip", calibrations_zip, name="desk-zip"),
]
