"""Drafts of clocks: opened, saved, undone; and the first guess."""

from __future__ import annotations

from typing import Any

from django.http import HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiExample, extend_schema
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import refusal, valid
from gtm_hit.api.common.staff import READS, WRITES, Pages, answers, caller
from gtm_hit.api.datasets.importing import source_named
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.api.sync.common import SyncView, draft_or_404, told
from gtm_hit.api.sync.shapes import (
    OpenSyncSerializer,
    SaveSyncSerializer,
    SyncRevisionSerializer,
    SyncRowShape,
    SyncShape,
)
from gtm_hit.models import VideoSync
from gtm_hit.ops.sync import drafts, job
from gtm_hit.ops.sync.state import Clock, Event, State
from gtm_hit.ops.sync.whole import whole

STALE = {**WRITES, 412: refusal("stale; details.current: the draft as it is now")}


class Syncs(SyncView, ListAPIView[VideoSync]):
    queryset = VideoSync.objects.all()
    serializer_class = SyncRowShape
    pagination_class = Pages

    @extend_schema(
        operation_id="video_syncs",
        summary="Folders whose videos' clocks are put together",
        responses=answers(200, SyncRowShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)

    @extend_schema(
        operation_id="open_video_sync",
        summary="Open a folder's videos, to put their clocks together",
        description="Makes the draft if there is none; the same folder has the same draft.",
        request=OpenSyncSerializer,
        responses=answers(200, SyncShape, WRITES),
        examples=[OpenApiExample("a folder", {"source": "incoming/plaza"}, request_only=True)],
    )
    def post(self, request: Request) -> Response:
        source = source_named(request, valid(OpenSyncSerializer(data=request.data))["source"])
        with told("source"):
            return _whole(drafts.open_draft(source, caller(request)))


class OneSync(SyncView):
    @extend_schema(
        operation_id="video_sync",
        summary="Clocks, events and the guess of a folder's videos",
        responses=answers(200, SyncShape, READS),
    )
    def get(self, request: Request, pk: int) -> Response:
        return _whole(draft_or_404(pk))

    @extend_schema(
        operation_id="save_video_sync",
        summary="Say what the clocks and events are now",
        request=SaveSyncSerializer,
        responses=answers(200, SyncShape, STALE),
    )
    def put(self, request: Request, pk: int) -> Response:
        draft_or_404(pk)
        wanted = valid(SaveSyncSerializer(data=request.data))
        clocks = tuple(Clock(**each) for each in wanted["clocks"])
        events = tuple(Event(**each) for each in wanted["events"])
        with told("clocks"):
            return _whole(drafts.save(pk, wanted["revision"], State(clocks, events, wanted["reference"])))


class UndoSync(SyncView):
    @extend_schema(
        operation_id="undo_video_sync",
        summary="Take the latest change back",
        description="Nothing happens where there is none.",
        request=SyncRevisionSerializer,
        responses=answers(200, SyncShape, STALE),
    )
    def post(self, request: Request, pk: int) -> Response:
        draft_or_404(pk)
        return _whole(drafts.undo(pk, _revision(request)))


class RedoSync(SyncView):
    @extend_schema(
        operation_id="redo_video_sync",
        summary="Do again what was undone last",
        request=SyncRevisionSerializer,
        responses=answers(200, SyncShape, STALE),
    )
    def post(self, request: Request, pk: int) -> Response:
        draft_or_404(pk)
        return _whole(drafts.redo(pk, _revision(request)))


class GuessSync(SyncView):
    @extend_schema(
        operation_id="guess_video_sync",
        summary="Guess the offsets",
        description="By sound, else by motion on the ground that calibrated cameras share. Changes no clock.",
        request=None,
        responses=answers(202, JobShape, WRITES),
    )
    def post(self, request: Request, pk: int) -> Response:
        return started(job.start(draft_or_404(pk), caller(request)))


class TakeSyncGuess(SyncView):
    @extend_schema(
        operation_id="take_video_sync_guess",
        summary="Set the clocks to what was guessed",
        request=SyncRevisionSerializer,
        responses=answers(200, SyncShape, STALE),
    )
    def post(self, request: Request, pk: int) -> Response:
        draft_or_404(pk)
        with told("guess"):
            return _whole(drafts.take_guess(pk, _revision(request)))


class SyncOffsets(SyncView):
    @extend_schema(
        operation_id="video_sync_offsets",
        summary="The offsets as a file for `importvideos --offsets`",
        responses={(200, "text/plain"): OpenApiTypes.STR, **READS},
    )
    def get(self, request: Request, pk: int) -> HttpResponse:
        text = "".join(f"{line}\n" for line in whole(draft_or_404(pk)).lines)
        answer = HttpResponse(text, content_type="text/plain; charset=utf-8")
        answer["Content-Disposition"] = 'attachment; filename="offsets.txt"'
        return answer


def _revision(request: Request) -> int:
    revision: int = valid(SyncRevisionSerializer(data=request.data))["revision"]
    return revision


def _whole(draft: VideoSync) -> Response:
    return Response(whole(draft).as_json())
