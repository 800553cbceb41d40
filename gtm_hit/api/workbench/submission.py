"""The end of an assignment."""

from __future__ import annotations

from typing import Any, cast

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import REFUSALS, refusal
from gtm_hit.api.workbench.places import PlacedView
from gtm_hit.models import Assignment
from gtm_hit.ops.work import assignments


class SubmittedSerializer(serializers.Serializer[Any]):
    code = serializers.CharField()
    summary = serializers.DictField()


class SubmitView(PlacedView):
    @extend_schema(
        summary="Submit the batch",
        description="Only when every frame is done on the server's record. Again: the same code.",
        request=None,
        responses={
            200: SubmittedSerializer,
            403: refusal("read_only; details.reason: expired"),
            409: refusal("unfinished; details.frames: numbers"),
            **REFUSALS,
        },
    )
    def post(self, request: Request) -> Response:
        submitted = assignments.submit(cast(Assignment, request.auth))
        return Response({"code": submitted.code, "summary": assignments.summary(submitted)})
