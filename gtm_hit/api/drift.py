"""Whether cameras still stand as they were calibrated: marks remembered, and frames compared with them."""

from __future__ import annotations

from typing import Any

from django.utils.translation import gettext as _
from drf_spectacular.utils import OpenApiExample, extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, WRITES, StaffView, answers, caller, dataset_or_404, invalid
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.models import ApiToken, DriftCheck, DriftMarks
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.drift import job, remembering
from gtm_hit.ops.drift.pictures import DriftRefused, Span

CHECKS_SHOWN = 20


class DriftOrderSerializer(serializers.Serializer[Any]):
    remember = StrictBooleanField(default=False, help_text="take marks instead of comparing with them")
    first = serializers.IntegerField(
        required=False,
        allow_null=True,
        default=None,
        min_value=0,
        max_value=LARGEST,
        help_text="frame number",
    )
    last = serializers.IntegerField(
        required=False, allow_null=True, default=None, min_value=0, max_value=LARGEST, help_text="included"
    )
    every = serializers.IntegerField(default=1, min_value=1, max_value=LARGEST, help_text="n-th frame only")

    def validate(self, given: dict[str, Any]) -> dict[str, Any]:
        if given["first"] is not None and given["last"] is not None and given["first"] > given["last"]:
            raise invalid("last", _("The last frame comes before the first."))
        return given


class RememberedMarksSerializer(serializers.ModelSerializer[DriftMarks]):
    camera = serializers.CharField(source="camera.name")

    class Meta:
        model = DriftMarks
        fields = ["camera", "count", "frames", "created_at"]


class DriftCheckSerializer(serializers.ModelSerializer[DriftCheck]):
    calibration = serializers.IntegerField(source="calibration.number")
    cameras = serializers.ListField(
        child=serializers.DictField(),
        help_text="verdict, px, cm … where the camera is farthest off, and of every frame",
    )

    class Meta:
        model = DriftCheck
        fields = ["id", "calibration", "frames", "warns", "cameras", "created_at"]


class DriftSerializer(serializers.Serializer[Any]):
    remembered = RememberedMarksSerializer(many=True, help_text="for the calibration in place")
    checks = DriftCheckSerializer(many=True, help_text="the newest first")


class DriftOfDataset(StaffView):
    write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.IMPORT

    @extend_schema(
        operation_id="drift",
        summary="What was remembered of each camera, and how far each has moved since",
        responses=answers(200, DriftSerializer, READS),
    )
    def get(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        found = {
            "remembered": remembering.remembered(dataset),
            "checks": dataset.drift_checks.select_related("calibration")[:CHECKS_SHOWN],
        }
        return Response(DriftSerializer(found).data)

    @extend_schema(
        operation_id="check_drift",
        summary="Remember marks of each camera, or compare frames with them",
        description="A job of the kind `drift`; the one under way when it is the same.",
        request=DriftOrderSerializer,
        responses=answers(202, JobShape, WRITES),
        examples=[OpenApiExample("every tenth frame", {"every": 10}, request_only=True)],
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(DriftOrderSerializer(data=request.data))
        remember = wanted.pop("remember")
        try:
            return started(job.start(dataset, Span(**wanted), remember, caller(request)))
        except DriftRefused as error:
            raise invalid("", error) from error
