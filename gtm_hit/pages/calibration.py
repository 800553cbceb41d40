from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django import forms
from django.contrib import messages
from django.core.files.uploadedfile import UploadedFile
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.http import require_http_methods, require_POST, require_safe

from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Dataset, Job
from gtm_hit.ops.access.jobs import jobs_of
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration import sides, versions
from gtm_hit.ops.calibration.cameras import UNITS
from gtm_hit.ops.calibration.reading import MOST_BYTES, file_report, read_upload
from gtm_hit.ops.calibration.replacing import ReplacementError
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.uploads import takes_uploads
from gtm_hit.pages.datasets.listing import dataset_or_404

ROWS_SHOWN = 20


class CalibrationForm(forms.Form):
    file = forms.FileField(label=gettext_lazy("cameras.json, or a zip of a folder of calibrations"))
    tvec_unit = forms.ChoiceField(
        label=gettext_lazy("Unit of tvec in XML and YAML"), choices=list(UNITS.items()), initial="m"
    )

    def clean_file(self) -> UploadedFile:
        file: UploadedFile = self.cleaned_data["file"]
        if (file.size or 0) > MOST_BYTES:
            raise forms.ValidationError(
                _("The file is larger than %(size)d MB.") % {"size": MOST_BYTES // 1_000_000}
            )
        return file


@dataclass(frozen=True)
class View:
    """One camera's picture with the boxes before and after."""

    name: str
    width: int
    height: int
    image: str
    before: list[tuple[int, int, int, int]]  # x, y, width, height
    after: list[tuple[int, int, int, int]]
    counts: dict[str, Any]


@require_http_methods(["GET", "HEAD", "POST"])
@takes_uploads(Role.MAINTAINER)
def calibration(request: StaffRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    form = CalibrationForm(request.POST or None, request.FILES or None)
    if request.method == "POST" and form.is_valid():
        try:
            cameras = read_upload(dataset, form.cleaned_data["file"], form.cleaned_data["tvec_unit"])
        except FormatError as error:
            for problem in error.problems:
                form.add_error("file", str(problem))
        else:
            file: UploadedFile = form.cleaned_data["file"]
            report = file_report(file.name or "", file.chunks(), form.cleaned_data["tvec_unit"])
            job = calibration_job.start(dataset, cameras, request.user, file.name or "", report=report)
            return redirect("job", pk=job.pk)
    context = {
        "section": "datasets",
        "tab": "calibration",
        "dataset": dataset,
        "form": form,
        "cameras": [
            (row.name, row.width, row.height, camera.centre.tolist(), row.matrix, camera.has_lens)
            for row in dataset.cameras.all()
            for camera in [row.calibrated]
        ],
        "versions": versions.versions(dataset)[:ROWS_SHOWN],
        "jobs": _jobs(request).filter(dataset=dataset)[:ROWS_SHOWN],
    }
    return render(request, "staff/imports/calibration.html", context)


@require_POST
@needs(Role.MAINTAINER)
def compare_version(request: StaffRequest, slug: str, number: int) -> HttpResponse:
    dataset = dataset_or_404(slug)
    try:
        return redirect("job", pk=calibration_job.start_version(dataset, number, request.user).pk)
    except versions.UnknownVersion as error:
        raise Http404(str(error)) from error


@require_safe
@needs(Role.MAINTAINER)
def preview(request: HttpRequest, slug: str, pk: int) -> HttpResponse:
    job = get_object_or_404(_jobs(request), pk=pk, dataset__slug=slug)
    if job.state != Job.State.DONE:
        return redirect("job", pk=pk)
    dataset, seen = dataset_or_404(slug), calibration_job.seen_by(request.user, job)
    context = {
        "section": "datasets",
        "tab": "calibration",
        "dataset": dataset,
        "job": job,
        "seen": seen,
        "views": _views(dataset, seen),
        "now": dataset.calibration.number if dataset.calibration else None,
        "key": sides.key_of(job),
    }
    return render(request, "staff/imports/calibration_preview.html", context)


@require_POST
@needs(Role.MAINTAINER)
def confirm(request: StaffRequest, slug: str, pk: int) -> HttpResponse:
    job = get_object_or_404(_jobs(request), pk=pk, dataset__slug=slug)
    try:
        calibration_job.confirm(job, request.user)
    except ReplacementError as error:
        messages.error(request, str(error))
        return redirect("calibration-preview", slug=slug, pk=pk)
    messages.success(request, _("The new calibration is in place."))
    return redirect("dataset", slug=slug)


def _jobs(request: HttpRequest) -> Any:
    return jobs_of(request.user).filter(kind=Job.Kind.REPLACE_CALIBRATION)


def _views(dataset: Dataset, seen: dict[str, Any]) -> list[View]:
    picture = seen["picture"]
    rows = list(dataset.cameras.all())
    if len(rows) != len(seen["cameras"]):
        raise Http404(_("The dataset's cameras have changed."))
    images = picture["images"] or [""] * len(rows)
    return [
        View(
            row.name,
            row.width,
            row.height,
            image,
            [_sized(box) for box in picture["before"][index]],
            [_sized(box) for box in picture["after"][index]],
            seen["cameras"][index],
        )
        for index, (row, image) in enumerate(zip(rows, images, strict=True))
    ]


def _sized(box: list[int]) -> tuple[int, int, int, int]:
    left, top, right, bottom = box
    return left, top, right - left, bottom - top


urlpatterns = [
    path("datasets/<slug:slug>/calibration/", calibration, name="dataset-calibration"),
    path(
        "datasets/<slug:slug>/calibration/versions/<int:number>/compare/",
        compare_version,
        name="calibration-version",
    ),
    path("datasets/<slug:slug>/calibration/<int:pk>/", preview, name="calibration-preview"),
    path("datasets/<slug:slug>/calibration/<int:pk>/confirm/", confirm, name="calibration-confirm"),
]
