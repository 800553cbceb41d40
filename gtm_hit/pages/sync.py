"""Putting the clocks of a folder's videos together."""

from __future__ import annotations

from dataclasses import dataclass

from django.conf import settings
from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import get_script_prefix, path
from django.utils.translation import gettext as _
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_safe

from gtm_hit.models import VideoSync
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.files import sources
from gtm_hit.ops.sync import drafts, job
from gtm_hit.ops.sync.guessing import SyncRefused
from gtm_hit.ops.sync.whole import whole
from gtm_hit.pages.common.access import StaffRequest, needs


@dataclass(frozen=True)
class Folder:
    key: str
    videos: int
    draft: VideoSync | None


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MAINTAINER, everywhere=True)
def sync_list(request: StaffRequest) -> HttpResponse:
    if request.method == "POST":
        source = sources.source(request.POST.get("source", ""))
        if source is None:
            messages.error(request, _("This folder is no longer there."))
            return redirect("syncs")
        try:
            return redirect("sync", pk=_opened(source, request).pk)
        except SyncRefused as error:
            messages.error(request, str(error))
            return redirect("syncs")
    context = {
        "section": "datasets",
        "tab": "sync",
        "folders": _folders(),
        "incoming": settings.INCOMING_ROOT,
    }
    return render(request, "staff/imports/syncs.html", context)


@require_safe
@never_cache
@needs(Role.MAINTAINER, everywhere=True)
def sync(request: StaffRequest, pk: int) -> HttpResponse:
    draft = get_object_or_404(VideoSync, pk=pk)
    prefix = f"{get_script_prefix()}api/v1/"
    given = {"draft": whole(draft).as_json(), "api": f"{prefix}video-syncs/{pk}/", "jobs": f"{prefix}jobs/"}
    return render(request, "sync.html", {"section": "datasets", "draft": draft, "sync": given})


def _opened(source: sources.Source, request: StaffRequest) -> VideoSync:
    """The first guess comes by itself; it changes no clock before somebody takes it."""
    draft = drafts.open_draft(source, request.user)
    if draft.position == 1 and not draft.guess:
        job.start(draft, request.user)
    return draft


def _folders() -> list[Folder]:
    known = {draft.source: draft for draft in VideoSync.objects.all()}
    found = [(each, len(sources.videos(each))) for each in sources.sources() if not each.is_archive]
    return [Folder(each.key, count, known.get(each.key)) for each, count in found if count]


urlpatterns = [
    path("video-syncs/", sync_list, name="syncs"),
    path("video-syncs/<int:pk>/", sync, name="sync"),
]
