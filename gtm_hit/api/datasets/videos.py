"""Datasets from videos that lie on the server."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from django.utils.translation import gettext as _
from drf_spectacular.utils import OpenApiExample, extend_schema
from rest_framework import exceptions, serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import StrictBooleanField
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import WRITES, StaffView, answers, caller, invalid
from gtm_hit.api.datasets.importing import (
    FiniteField,
    SceneSerializer,
    refuse_impossible,
    source_named,
)
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.models import ApiToken
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.datasets import job
from gtm_hit.ops.datasets.videos.options import MOST_DRIFT, VideoSource
from gtm_hit.ops.files import sources


class VideoSerializer(serializers.Serializer[Any]):
    camera = serializers.CharField(max_length=80, help_text="name of the camera, as in the calibration")
    file = serializers.CharField(max_length=300, help_text="seen from the source's folder")
    offset = FiniteField(
        default=0.0, help_text="seconds in this video at which the time all videos share is 0"
    )
    drift = FiniteField(
        default=0.0,
        min_value=-MOST_DRIFT,
        max_value=MOST_DRIFT,
        help_text="parts per million by which its clock is fast",
    )


class ImportVideosSerializer(SceneSerializer):
    videos = serializers.ListField(child=VideoSerializer(), min_length=1, max_length=100)
    start = FiniteField(default=0.0, min_value=0, help_text="seconds of the shared time")
    until = FiniteField(default=None, allow_null=True, min_value=0, help_text="seconds; null: to the end")
    as_taken = StrictBooleanField(default=False, help_text="leave the lens in the pictures")


class VideoImports(StaffView):
    write_role = Role.MAINTAINER
    everywhere = True
    write_scope = ApiToken.Scope.IMPORT

    @extend_schema(
        operation_id="import_videos",
        summary="Import the frames of videos",
        description="The source is a folder that holds the videos and their calibrations. "
        "The same again continues where an earlier job was stopped.",
        request=ImportVideosSerializer,
        responses=answers(202, JobShape, WRITES),
        examples=[
            OpenApiExample(
                "two cameras",
                {
                    "source": "incoming/plaza",
                    "slug": "plaza",
                    "preset": "wildtrack",
                    "videos": [
                        {"camera": "C1", "file": "one.mp4", "offset": 12.4},
                        {"camera": "C2", "file": "two.mp4", "offset": 13.05},
                    ],
                },
                request_only=True,
            )
        ],
    )
    def post(self, request: Request) -> Response:
        options = valid(ImportVideosSerializer(data=request.data))
        source, videos = source_named(request, options.pop("source")), options.pop("videos")
        start, until = options.pop("start"), options.pop("until")
        refuse_missing(source, videos)
        options["values"] = job.video_values(options["slug"], options["preset"], options["values"])
        options["undistort"] = not options.pop("as_taken")
        refuse_impossible(options)
        found = [
            VideoSource(each["camera"], Path(each["file"]), each["offset"], each["drift"]) for each in videos
        ]
        return started(job.start_videos(source, options, found, start, until, caller(request)))


def refuse_missing(source: sources.Source, videos: list[dict[str, Any]]) -> None:
    if source.is_archive:
        raise invalid("source", _("Videos are imported from a folder, not from an archive."))
    reasons = {
        str(index): {"file": [_("There is no such file in the source's folder.")]}
        for index, each in enumerate(videos)
        if "\x00" in each["file"] or not sources.holds(source, Path(each["file"]))
    }
    if reasons:
        raise exceptions.ValidationError({"videos": reasons})
