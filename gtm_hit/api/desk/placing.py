"""A desk's calibration where it is used: compared with the dataset's, or as files."""

from __future__ import annotations

from django.http import HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.staff import ASKS, WRITES, answers, caller
from gtm_hit.api.desk.common import DeskView, desk_or_404, told
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.ops.desk import placing


class CompareDesk(DeskView):
    @extend_schema(
        operation_id="compare_desk",
        summary="Compare the dataset's boxes with those of the desk's cameras",
        description="The job is a change of calibration: look at it and confirm it like one of a file.",
        request=None,
        responses=answers(202, JobShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        with told("cameras"):
            return started(placing.compare(found, caller(request)))


class DeskCamerasJson(DeskView):
    @extend_schema(
        operation_id="desk_cameras_json",
        summary="All cameras as a cameras.json, in metres",
        responses={(200, "application/json"): OpenApiTypes.BINARY, **ASKS},
    )
    def get(self, request: Request, desk: str) -> HttpResponse:
        with told("cameras"):
            data = placing.cameras_json(desk_or_404(request, desk))
        return HttpResponse(data, content_type="application/json")


class DeskFolder(DeskView):
    @extend_schema(
        operation_id="desk_calibrations",
        summary="All cameras laid out as WILDTRACK publishes its own, in centimetres",
        responses={(200, "application/zip"): OpenApiTypes.BINARY, **ASKS},
    )
    def get(self, request: Request, desk: str) -> HttpResponse:
        with told("cameras"):
            data = placing.folder_zip(desk_or_404(request, desk))
        return HttpResponse(data, content_type="application/zip")
