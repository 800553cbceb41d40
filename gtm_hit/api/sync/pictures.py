"""What videos show, picture by picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from django.http import Http404, HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request

from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.staff import ASKS, asked, invalid
from gtm_hit.api.sync.common import SyncView, draft_or_404, told
from gtm_hit.models import VideoSync
from gtm_hit.ops.sync import pictures
from gtm_hit.ops.sync.whole import video_path

MOST_TOGETHER = 30  # pictures of a strip
DAY = 24 * 3600


class SyncPictureQuery(serializers.Serializer[Any]):
    at = serializers.IntegerField(
        required=False, min_value=-LARGEST, max_value=LARGEST, help_text="milliseconds of the video"
    )
    frame = serializers.IntegerField(
        required=False,
        min_value=0,
        max_value=LARGEST,
        help_text="instead of `at`: the picture, from 0",
    )
    width = serializers.ChoiceField(choices=pictures.WIDTHS, default=960, help_text="at most, pixels")


class SyncStripQuery(serializers.Serializer[Any]):
    at = serializers.IntegerField(min_value=0, max_value=LARGEST, help_text="milliseconds of the video")
    step = serializers.IntegerField(min_value=1, max_value=60_000, default=100, help_text="milliseconds")
    count = serializers.IntegerField(min_value=1, max_value=MOST_TOGETHER, default=20)
    width = serializers.ChoiceField(choices=pictures.WIDTHS, default=480, help_text="at most, pixels")


class PictureView(SyncView):
    """Pictures are no JSON: a client that accepts nothing else is right here."""

    def perform_content_negotiation(self, request: Request, force: bool = False) -> Any:
        return super().perform_content_negotiation(request, force=True)


class SyncPicture(PictureView):
    @extend_schema(
        operation_id="video_sync_picture",
        summary="The picture of a video that is nearest to an instant",
        description="`X-Picture-Times` has its own time, seconds of the video.",
        parameters=[SyncPictureQuery],
        responses={(200, "image/jpeg"): OpenApiTypes.BINARY, **ASKS},
    )
    def get(self, request: Request, pk: int, video: int) -> HttpResponse:
        draft = draft_or_404(pk)
        path, wanted = _path_or_404(draft, video), asked(request, SyncPictureQuery)
        facts = draft.facts[video]
        if ("at" in wanted) == ("frame" in wanted):
            raise invalid("at", "Say either at or frame.")
        at = wanted.get("at", 0)
        if "frame" in wanted:
            at = round(1000 * (facts["start"] + wanted["frame"] * facts["interval"]))
        with told("at"):
            found = pictures.picture(path, facts, at, wanted["width"])
        return _jpeg(found.jpeg, [found.time])


class SyncStrip(PictureView):
    @extend_schema(
        operation_id="video_sync_strip",
        summary="Some pictures of a video, one below the other, for playing",
        description="`X-Picture-Times` has the time of each, seconds of the video; fewer where it ends.",
        parameters=[SyncStripQuery],
        responses={(200, "image/jpeg"): OpenApiTypes.BINARY, **ASKS},
    )
    def get(self, request: Request, pk: int, video: int) -> HttpResponse:
        draft = draft_or_404(pk)
        path, wanted = _path_or_404(draft, video), asked(request, SyncStripQuery)
        with told("at"):
            found = pictures.strip(path, draft.facts[video], **wanted)
        return _jpeg(found.jpeg, found.times)


def _path_or_404(draft: VideoSync, video: int) -> Path:
    path = video_path(draft, video)
    if path is None:
        raise Http404
    return path


def _jpeg(data: bytes, times: Sequence[float]) -> HttpResponse:
    answer = HttpResponse(data, content_type="image/jpeg")
    answer["X-Picture-Times"] = " ".join(f"{time:.6f}" for time in times)
    answer["Cache-Control"] = f"private, max-age={DAY}"
    return answer
