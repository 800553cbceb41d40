"""What the pages of a desk share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.contrib import messages
from django.http import Http404, HttpRequest
from django.shortcuts import get_object_or_404
from django.urls import get_script_prefix
from django.utils.translation import gettext as _

from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Desk, DeskCamera
from gtm_hit.ops.access.desks import desks_of
from gtm_hit.ops.desk.errors import DeskError


def desk_or_404(request: HttpRequest, slug: str) -> Desk:
    return get_object_or_404(desks_of(request.user).select_related("dataset", "created_by"), slug=slug)


def camera_or_404(desk: Desk, name: str) -> DeskCamera:
    found = desk.cameras.filter(name=name).first()
    if found is None:
        raise Http404(_("The desk has no camera “%(name)s”.") % {"name": name})
    return found


def frame(desk: Desk, tab: str) -> dict[str, Any]:
    """What every page of a desk shows around its own."""
    first = desk.cameras.order_by("index").first()
    return {
        "section": "datasets",
        "desk": desk,
        "tab": tab,
        "first_camera": first.name if first else "",
        "api": f"{get_script_prefix()}api/v1/calibration-desks/{desk.slug}/",
    }


def tried(request: HttpRequest, operation: Callable[[], object], done: str = "") -> bool:
    """Whether it worked; what it refuses is said on the next page."""
    try:
        operation()
    except DeskError as error:
        messages.error(request, str(error))
    except FormatError as error:
        for problem in error.problems[:10]:
            messages.error(request, str(problem))
        if len(error.problems) > 10:
            more = len(error.problems) - 10
            messages.error(request, _("… and %(more)d more.") % {"more": more})
    else:
        if done:
            messages.success(request, done)
        return True
    return False
