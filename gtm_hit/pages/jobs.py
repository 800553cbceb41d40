from __future__ import annotations

from django.conf import settings
from django.contrib import messages
from django.core.paginator import Paginator
from django.http import FileResponse, Http404, HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_POST, require_safe

from gtm_hit.models import Job
from gtm_hit.ops.access.jobs import jobs_of
from gtm_hit.ops.access.roles import CARES
from gtm_hit.ops.exports import expiry, exporting
from gtm_hit.ops.jobs import queue as job_ops
from gtm_hit.pages.common.access import StaffRequest, needs

ROWS_PER_PAGE = 50
EXPORTS = {Job.Kind.EXPORT_LAYER, Job.Kind.MAKE_RELEASE}
DIGESTS_SHOWN = 200


def job_or_404(request: HttpRequest, pk: int) -> Job:
    return get_object_or_404(jobs_of(request.user), pk=pk)


@require_safe
@never_cache
@needs(CARES)
def job(request: HttpRequest, pk: int) -> HttpResponse:
    shown = job_or_404(request, pk)
    export = exporting.finished(shown)
    context = {
        "section": "exports" if shown.kind in EXPORTS else "datasets",
        "job": shown,
        "percent": percent(shown),
        "export": export,
        "removed": expiry.removed(shown),
        "expires_at": expiry.expires_at(shown),
        "keep_days": settings.EXPORT_KEEP_DAYS,
        "digests": export.files[:DIGESTS_SHOWN] if export else [],
        "more_digests": max(len(export.files) - DIGESTS_SHOWN, 0) if export else 0,
    }
    return render(request, "staff/job.html", context)


@require_POST
@needs(CARES)
def cancel(request: HttpRequest, pk: int) -> HttpResponse:
    job_ops.cancel(job_or_404(request, pk))
    return redirect("job", pk=pk)


@require_POST
@needs(CARES)
def retry(request: StaffRequest, pk: int) -> HttpResponse:
    shown = job_or_404(request, pk)
    if not shown.finished:
        messages.warning(request, _("This job is still under way."))
        return redirect("job", pk=pk)
    return redirect("job", pk=job_ops.retry(shown, request.user).pk)


@require_safe
@needs(CARES)
def download(request: HttpRequest, pk: int) -> HttpResponse | FileResponse:
    shown = job_or_404(request, pk)
    if expiry.removed(shown):
        return redirect("job", pk=pk)  # which says why, and offers to make it again
    export = exporting.finished(shown)
    if export is None:
        raise Http404(_("This job has no file to download."))
    return FileResponse(export.archive.open("rb"), as_attachment=True, filename=export.archive_name)


@require_POST
@needs(CARES)
def delete_files(request: HttpRequest, pk: int) -> HttpResponse:
    if not expiry.delete(job_or_404(request, pk)):
        messages.warning(request, _("This job has no files to delete."))
    return redirect("job", pk=pk)


@require_safe
@needs(CARES)
def exports(request: HttpRequest) -> HttpResponse:
    found = jobs_of(request.user).filter(kind=Job.Kind.EXPORT_LAYER)
    page = Paginator(found, ROWS_PER_PAGE).get_page(request.GET.get("page"))
    return render(
        request, "staff/exports.html", {"section": "exports", "page": page, "jobs": page.object_list}
    )


def percent(shown: Job) -> int:
    return 100 * shown.done // shown.total if shown.total else 0


urlpatterns = [
    path("exports/", exports, name="exports"),
    path("jobs/<int:pk>/", job, name="job"),
    path("jobs/<int:pk>/cancel/", cancel, name="job-cancel"),
    path("jobs/<int:pk>/retry/", retry, name="job-retry"),
    path("jobs/<int:pk>/download/", download, name="job-download"),
    path("jobs/<int:pk>/delete-files/", delete_files, name="job-delete-files"),
]
