from __future__ import annotations

from django.conf import settings
from django.core.paginator import Paginator
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.views.decorators.http import require_http_methods

from gtm_hit.models import Job, VideoSync
from gtm_hit.ops.access.jobs import jobs_of
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.datasets import job as import_jobs
from gtm_hit.ops.files import sources
from gtm_hit.ops.sync import drafts
from gtm_hit.ops.sync.state import source_lines
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.uploads import takes_uploads
from gtm_hit.pages.datasets.forms import DatasetForm, VideosForm

ROWS_PER_PAGE = 20
KINDS = [Job.Kind.IMPORT_DATASET, Job.Kind.IMPORT_VIDEOS]


@require_http_methods(["GET", "HEAD", "POST"])
@takes_uploads(Role.MAINTAINER)
def new_dataset(request: StaffRequest) -> HttpResponse:
    initial = {"desk": request.GET.get("desk", "")}
    form = DatasetForm(request.user, request.POST or None, request.FILES or None, initial=initial)
    if request.method == "POST":
        if not form.is_valid():
            form.keep_archive()
        elif source := _chosen(form):
            return redirect("job", pk=import_jobs.start_import(source, form.options(), request.user).pk)
    found = jobs_of(request.user).filter(kind__in=KINDS)
    context = {
        "section": "datasets",
        "tab": "images",
        "form": form,
        "most_bytes": sources.most_bytes(),
        "most_megabytes": settings.MAX_UPLOAD_MB,
        "incoming": settings.INCOMING_ROOT,
        "page": Paginator(found, ROWS_PER_PAGE).get_page(request.GET.get("page")),
    }
    return render(request, "staff/imports/new.html", context)


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MAINTAINER, everywhere=True)
def new_videos(request: StaffRequest) -> HttpResponse:
    form = VideosForm(request.POST or None, initial=_first_values(request))
    if (
        request.method == "POST"
        and form.is_valid()
        and (source := sources.source(form.cleaned_data["source"]))
    ):
        cleaned = form.cleaned_data
        job = import_jobs.start_videos(
            source,
            form.options(),
            cleaned["videos"],
            cleaned["start"] or 0.0,
            cleaned["until"],
            request.user,
        )
        return redirect("job", pk=job.pk)
    context = {
        "section": "datasets",
        "tab": "videos",
        "form": form,
        "folders": [each for each in sources.sources() if not each.is_archive],
        "incoming": settings.INCOMING_ROOT,
    }
    return render(request, "staff/imports/videos.html", context)


def _chosen(form: DatasetForm) -> sources.Source | None:
    """The archive just uploaded, or the source on the server; None with the form's errors."""
    if form.cleaned_data.get("archive"):
        return form.archive_source()
    return sources.source(form.cleaned_data["source"])


def _first_values(request: StaffRequest) -> dict[str, str]:
    """Of a folder's videos, or of clocks that were put together."""
    number = request.GET.get("sync", "")
    if number.isdecimal() and len(number) < 10 and (draft := VideoSync.objects.filter(pk=number).first()):
        return {"source": draft.source, "videos": "\n".join(source_lines(drafts.current(draft)))}
    folder = sources.source(request.GET.get("source", ""))
    return {"source": folder.key, "videos": _suggested(folder)} if folder else {}


def _suggested(folder: sources.Source) -> str:
    lines = [f"{name.stem} = {name} @ 0" for name in sources.videos(folder)]
    return "\n".join(lines) or _("No videos lie in this folder.")


urlpatterns = [
    path("imports/", new_dataset, name="imports"),
    path("imports/videos/", new_videos, name="import-videos"),
]
