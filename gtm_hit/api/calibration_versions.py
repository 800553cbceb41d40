"""The calibrations a dataset has had: what each is from, what was made under it, how two of them differ."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import Http404
from drf_spectacular.utils import OpenApiParameter, extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.calibration import MovedInCameraSerializer
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import ASKS, READS, Pages, StaffView, answers, dataset_or_404, invalid
from gtm_hit.models import Calibration, CalibrationPlacement, Dataset
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.calibration.differences import NotComparable, content, difference
from gtm_hit.ops.calibration.sides import Side, UnknownSide, side
from gtm_hit.ops.calibration.usage import usage
from gtm_hit.ops.desk.errors import DeskError

REPORT = "digests of its inputs, settings and figures; empty where nothing is known"
SIDE = "a version's number, `desk:NAME` for what a desk has now, or `job:NUMBER` for what was only compared"


class VersionSerializer(serializers.ModelSerializer[Calibration]):
    created_by = serializers.CharField(source="created_by.username", default=None, allow_null=True)
    in_place = serializers.SerializerMethodField()

    class Meta:
        model = Calibration
        fields = ["number", "in_place", "source", "digest", "created_by", "created_at"]

    def get_in_place(self, row: Calibration) -> bool:
        return row.dataset.calibration_id == row.pk


class PlacementSerializer(serializers.ModelSerializer[CalibrationPlacement]):
    created_by = serializers.CharField(source="created_by.username", default=None, allow_null=True)
    report = serializers.DictField(help_text=REPORT)

    class Meta:
        model = CalibrationPlacement
        fields = ["created_at", "created_by", "source", "report"]


class VersionUsageSerializer(serializers.Serializer[Any]):
    saves = serializers.IntegerField()
    layers = serializers.IntegerField(help_text="that these saves are of")
    releases = serializers.ListField(child=serializers.IntegerField(), help_text="their numbers")


class WholeVersionSerializer(VersionSerializer):
    cameras = serializers.DictField(help_text="the content of a cameras.json")
    report = serializers.DictField(help_text=REPORT)
    placements = PlacementSerializer(many=True, help_text="each time it was put in place again")
    made_under_it = serializers.SerializerMethodField()

    class Meta(VersionSerializer.Meta):
        fields = [*VersionSerializer.Meta.fields, "cameras", "report", "placements", "made_under_it"]

    @extend_schema_field(VersionUsageSerializer)
    def get_made_under_it(self, row: Calibration) -> dict[str, Any]:
        return VersionUsageSerializer(usage(row)).data


class SideSerializer(serializers.Serializer[Any]):
    key = serializers.CharField()
    words = serializers.CharField()


class ComparedLensSerializer(serializers.Serializer[Any]):
    fx = serializers.FloatField(help_text="pixels")
    fy = serializers.FloatField(help_text="pixels")
    cx = serializers.FloatField(help_text="pixels")
    cy = serializers.FloatField(help_text="pixels")


class GroundShiftSerializer(serializers.Serializer[Any]):
    seen = serializers.IntegerField(help_text="cells of the ground the camera saw before")
    lost = serializers.IntegerField(help_text="those whose pixel shows no ground any more")
    median = serializers.FloatField(allow_null=True, help_text="cm")
    p95 = serializers.FloatField(allow_null=True, help_text="cm")
    most = serializers.FloatField(allow_null=True, help_text="cm")


class CameraDifferenceSerializer(serializers.Serializer[Any]):
    name = serializers.CharField()
    centre_cm = serializers.FloatField(help_text="from centre to centre")
    centre_along_cm = serializers.ListField(child=serializers.FloatField(), help_text="along X, Y and Z")
    rotation_degrees = serializers.FloatField()
    before = ComparedLensSerializer()
    after = ComparedLensSerializer()
    distortion_px = serializers.FloatField(
        allow_null=True, help_text="what the change of distortion alone moves, at the worst place"
    )
    ground_cm = GroundShiftSerializer(help_text="where a pixel lies on the ground")
    boxes = MovedInCameraSerializer()


class ShiftMapSerializer(serializers.Serializer[Any]):
    origin = serializers.ListField(child=serializers.FloatField(), help_text="of the ground: X and Y, metres")
    cell_metres = serializers.FloatField()
    columns = serializers.IntegerField(help_text="cells along X")
    rows = serializers.IntegerField(help_text="cells along Y")
    worst_cm = serializers.ListField(
        child=serializers.ListField(child=serializers.FloatField(allow_null=True)),
        help_text="row by row, the largest shift of all cameras; null where none sees the ground, "
        "-1 where a pixel shows no ground any more",
    )


class DifferenceSerializer(serializers.Serializer[Any]):
    before = SideSerializer()
    after = SideSerializer()
    cameras = CameraDifferenceSerializer(many=True)
    annotations = serializers.IntegerField(help_text="of all layers")
    compared = serializers.IntegerField(help_text="those whose boxes were compared, taken evenly from all")
    ground = ShiftMapSerializer()


class WantedSidesSerializer(serializers.Serializer[Any]):
    before = serializers.CharField(max_length=120)
    after = serializers.CharField(max_length=120)


class Versions(StaffView, ListAPIView[Calibration]):
    queryset = Calibration.objects.none()
    serializer_class = VersionSerializer
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Calibration]:
        return versions.versions(dataset_or_404(self.kwargs["slug"]))

    @extend_schema(
        operation_id="calibration_versions",
        summary="Every calibration the dataset has had, the newest first",
        responses=answers(200, VersionSerializer(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class OneVersion(StaffView):
    @extend_schema(
        operation_id="calibration_version",
        summary="A calibration the dataset has or had: its cameras, what it is from, what was made under it",
        responses=answers(200, WholeVersionSerializer, READS),
    )
    def get(self, request: Request, slug: str, number: int) -> Response:
        try:
            found = versions.version(dataset_or_404(slug), number)
        except versions.UnknownVersion as error:
            raise Http404 from error
        return Response(WholeVersionSerializer(found).data)


class Differences(StaffView):
    read_role = Role.MAINTAINER

    @extend_schema(
        operation_id="calibration_differences",
        summary="How two calibrations differ: cameras, the ground in centimetres, boxes",
        description="Nothing is written. Boxes are those of at most 20,000 annotations, taken evenly.",
        parameters=[
            OpenApiParameter("before", str, required=True, description=SIDE),
            OpenApiParameter("after", str, required=True, description="the same"),
        ],
        responses=answers(200, DifferenceSerializer, ASKS),
    )
    def get(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(WantedSidesSerializer(data=request.query_params))
        before, after = (self.side(dataset, name, wanted[name]) for name in ("before", "after"))
        try:
            return Response(content(difference(dataset, before, after)))
        except NotComparable as error:
            raise invalid("after", error) from error

    def side(self, dataset: Dataset, name: str, key: str) -> Side:
        try:
            return side(dataset, key)
        except (UnknownSide, versions.UnknownVersion, DeskError) as error:
            raise invalid(name, error) from error
