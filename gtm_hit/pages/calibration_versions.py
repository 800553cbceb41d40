"""One version of a dataset's calibration, and two calibrations beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import render
from django.urls import path
from django.views.decorators.http import require_safe

from gtm_hit.models import Dataset
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.calibration import sides, versions
from gtm_hit.ops.calibration.differences import Difference, NotComparable, difference
from gtm_hit.ops.calibration.usage import placings, usage
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.ground.coverage import coverage
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.datasets.ground_map import GroundMap
from gtm_hit.pages.datasets.listing import dataset_or_404


@dataclass(frozen=True)
class CameraLine:
    """One camera in the tables and as a small map."""

    change: Any
    focal: Sequence[tuple[float, float]]  # fx and fy: after, and by how much
    centre: Sequence[tuple[float, float]]  # cx and cy
    bands: Sequence[Any]
    boxes: dict[str, Any]


@require_safe
@needs(Role.MAINTAINER)
def version(request: HttpRequest, slug: str, number: int) -> HttpResponse:
    dataset = dataset_or_404(slug)
    try:
        found = versions.version(dataset, number)
    except versions.UnknownVersion as error:
        raise Http404(str(error)) from error
    context = {
        "section": "datasets",
        "tab": "calibration",
        "dataset": dataset,
        "version": found,
        "in_place": found.pk == dataset.calibration_id,
        "now": dataset.calibration.number if dataset.calibration else None,
        "usage": usage(found),
        "placings": placings(found),
        "cameras": versions.cameras_in(found),
    }
    return render(request, "staff/imports/calibration_version.html", context)


@require_safe
@needs(Role.MAINTAINER)
def differences(request: HttpRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    offered = sides.choices(dataset)
    before, after = _wanted(request, dataset, offered)
    found, problem = _difference(dataset, before, after) if len(offered) > 1 else (None, "")
    context = {
        "section": "datasets",
        "tab": "calibration",
        "dataset": dataset,
        "choices": offered,
        "before": before,
        "after": after,
        "problem": problem,
        "found": found,
        **(_drawn(dataset, found) if found else {}),
    }
    return render(request, "staff/imports/calibration_differences.html", context)


def _wanted(request: HttpRequest, dataset: Dataset, offered: Sequence[sides.Choice]) -> tuple[str, str]:
    """What was asked for; else what is in use beside the newest of the others."""
    used = str(dataset.calibration.number) if dataset.calibration else ""
    others = [choice.key for choice in offered if choice.key != used]
    before = request.GET.get("before") or (others[0] if others else used)
    return before, request.GET.get("after") or used


def _difference(dataset: Dataset, before: str, after: str) -> tuple[Difference | None, str]:
    """Or why there is none."""
    try:
        return difference(dataset, sides.side(dataset, before), sides.side(dataset, after)), ""
    except (sides.UnknownSide, versions.UnknownVersion, DeskError, NotComparable) as error:
        return None, str(error)


def _drawn(dataset: Dataset, found: Difference) -> dict[str, Any]:
    seen = coverage(dataset)
    return {
        "lines": [_line(found, index) for index in range(len(found.boxes))],
        "map": GroundMap(dataset, seen),
        "worst": found.worst_bands(),
    }


def _line(found: Difference, index: int) -> CameraLine:
    change = found.change.cameras[index]
    new, step = change.after.matrix, change.after.matrix - change.before.matrix
    return CameraLine(
        change,
        [(new[0, 0], step[0, 0]), (new[1, 1], step[1, 1])],
        [(new[0, 2], step[0, 2]), (new[1, 2], step[1, 2])],
        found.bands(index),
        found.boxes[index],
    )


urlpatterns = [
    path("datasets/<slug:slug>/calibration/differences/", differences, name="calibration-differences"),
    path("datasets/<slug:slug>/calibration/versions/<int:number>/", version, name="calibration-version-page"),
]
