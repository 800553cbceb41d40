"""Points kept with their clicks, and how far they are off."""

from __future__ import annotations

from typing import Any

from django.http import HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, WRITES, answers, caller
from gtm_hit.api.desk.common import DeskFileParser, DeskView, desk_or_404, told
from gtm_hit.api.desk.ground import PixelSerializer, StepsShape
from gtm_hit.models import KeptPoint
from gtm_hit.ops.desk import checks, kept
from gtm_hit.ops.desk.kept import SeenAt

USE_WORDS = "a test point is given to no solve"


class SeenSerializer(PixelSerializer):
    camera = serializers.CharField(max_length=80)


class NewKeptSerializer(serializers.Serializer[Any]):
    name = serializers.CharField(
        max_length=kept.NAME_LENGTH, default="", allow_blank=True, help_text="empty: the next of P1, P2, …"
    )
    use = serializers.ChoiceField(choices=KeptPoint.Use.choices, help_text=USE_WORDS)
    clicks = SeenSerializer(many=True, help_text="in two cameras or more")


class ChangedKeptSerializer(serializers.Serializer[Any]):
    name = serializers.CharField(max_length=kept.NAME_LENGTH, required=False)
    use = serializers.ChoiceField(choices=KeptPoint.Use.choices, required=False, help_text=USE_WORDS)


class KeptFileSerializer(serializers.Serializer[Any]):
    file = serializers.FileField(help_text="CSV of thing,camera,x,y[,use], or a JSON list of such objects")
    use = serializers.ChoiceField(
        choices=KeptPoint.Use.choices, default=KeptPoint.Use.TEST, help_text="where the file says none"
    )


class AgainstSerializer(serializers.Serializer[Any]):
    against = serializers.ChoiceField(
        choices=[each.value for each in checks.Against], default=checks.Against.DESK.value
    )


class LackShape(serializers.Serializer[Any]):
    page = serializers.CharField(help_text="where it is done: lens or ground")
    words = serializers.CharField()


class CheckCameraShape(serializers.Serializer[Any]):
    name = serializers.CharField()
    width = serializers.IntegerField(help_text="pixels")
    height = serializers.IntegerField()
    placed = serializers.BooleanField(help_text="whether it is calibrated and takes part")
    lacks = LackShape(allow_null=True, help_text="the step it needs at the desk; null: none")


class PlainKeptShape(serializers.Serializer[Any]):
    name = serializers.CharField()
    use = serializers.ChoiceField(choices=KeptPoint.Use.choices)
    clicks = SeenSerializer(many=True)


class KeptShape(StepsShape):
    kept = PlainKeptShape(many=True)


class KeptClickShape(serializers.Serializer[Any]):
    camera = serializers.CharField()
    x = serializers.FloatField(help_text="pixels")
    y = serializers.FloatField()
    residual = serializers.FloatField(allow_null=True, help_text="pixels")
    doubtful = serializers.BooleanField(help_text="beyond 3 σ")


class KeptPointShape(serializers.Serializer[Any]):
    name = serializers.CharField()
    use = serializers.ChoiceField(choices=KeptPoint.Use.choices)
    clicks = KeptClickShape(many=True)
    reason = serializers.CharField(help_text="why it has no place; empty: it has one")
    place = serializers.ListField(
        child=serializers.FloatField(), allow_null=True, help_text="X, Y and height, metres"
    )
    sigmas = serializers.ListField(child=serializers.FloatField(), allow_null=True, help_text="± metres")
    ground_sigma = serializers.FloatField(allow_null=True, help_text="± metres, X and Y together")
    angle = serializers.FloatField(allow_null=True, help_text="degrees at which the rays cross")


class KeptSummaryShape(serializers.Serializer[Any]):
    points = serializers.IntegerField(help_text="that have a place")
    clicks = serializers.IntegerField()
    off = serializers.IntegerField(help_text="clicks beyond 3 σ")
    median = serializers.FloatField(allow_null=True, help_text="pixels")
    p95 = serializers.FloatField(allow_null=True, help_text="pixels")
    by_camera = serializers.DictField(child=serializers.FloatField(), help_text="median, pixels")


class CheckShape(StepsShape):
    against = serializers.CharField()
    cameras = CheckCameraShape(many=True)
    kept = KeptPointShape(many=True)
    summaries = serializers.DictField(child=KeptSummaryShape(), help_text="by use")


class OneKeptShape(StepsShape):
    was = serializers.CharField(help_text="its name before; empty: it is new")
    point = KeptPointShape(allow_null=True, help_text="null: it is removed")


class Check(DeskView):
    @extend_schema(
        operation_id="desk_check",
        summary="Kept points and how far their clicks are off",
        parameters=[
            OpenApiParameter(
                "against", str, description="`desk`, its own cameras, or `in-place`, the dataset's"
            )
        ],
        responses=answers(200, CheckShape, WRITES),
    )
    def get(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(AgainstSerializer(data=request.query_params))
        return Response(checks.whole(found, checks.Against(wanted["against"])))


class KeptPoints(DeskView):
    @extend_schema(
        operation_id="kept_points",
        summary="Kept points with their clicks, without figures",
        responses=answers(200, KeptShape, READS),
    )
    def get(self, request: Request, desk: str) -> Response:
        return Response(checks.points(desk_or_404(request, desk)))

    @extend_schema(
        operation_id="keep_point",
        summary="Keep a point with its clicks",
        request=NewKeptSerializer,
        responses=answers(201, OneKeptShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(NewKeptSerializer(data=request.data))
        clicks = [SeenAt(each["camera"], each["x"], each["y"]) for each in wanted["clicks"]]
        with told("clicks"):
            made = kept.keep(found, clicks, wanted["use"], wanted["name"], caller(request))
        return Response(checks.one(found, made, ""), status=201)


class KeptFile(DeskView):
    parser_classes = [DeskFileParser]

    @extend_schema(
        operation_id="keep_points_of_file",
        summary="Keep all points of a file of clicks",
        request={"multipart/form-data": KeptFileSerializer},
        responses=answers(200, CheckShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(KeptFileSerializer(data=request.data))
        with told("file"):
            file = wanted["file"]
            kept.put_file(found, file.read(), file.name or "clicks", wanted["use"], caller(request))
        return Response(checks.whole(found))


class KeptCsv(DeskView):
    @extend_schema(
        operation_id="kept_points_csv",
        summary="All kept points as a file that can be read again",
        responses={(200, "text/csv"): OpenApiTypes.BINARY, **READS},
    )
    def get(self, request: Request, desk: str) -> HttpResponse:
        return HttpResponse(kept.as_csv(desk_or_404(request, desk)), content_type="text/csv")


class OneKeptPoint(DeskView):
    @extend_schema(
        operation_id="change_kept_point",
        summary="Give a kept point another name or use",
        request=ChangedKeptSerializer,
        responses=answers(200, OneKeptShape, WRITES),
    )
    def patch(self, request: Request, desk: str, point: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(ChangedKeptSerializer(data=request.data))
        with told("name" if "name" in wanted else "use"):
            changed = kept.change(
                found, point, wanted.get("name", ""), wanted.get("use", ""), caller(request)
            )
        return Response(checks.one(found, changed, point))

    @extend_schema(
        operation_id="remove_kept_point",
        summary="Remove a kept point with its clicks",
        responses=answers(200, OneKeptShape, READS),
    )
    def delete(self, request: Request, desk: str, point: str) -> Response:
        found = desk_or_404(request, desk)
        with told():
            kept.remove(found, point, caller(request))
        return Response(checks.one(found, None, point))


class KeptClickView(DeskView):
    @extend_schema(
        operation_id="put_kept_click",
        summary="Say where a camera sees a kept point",
        request=PixelSerializer,
        responses=answers(200, OneKeptShape, WRITES),
    )
    def put(self, request: Request, desk: str, point: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(PixelSerializer(data=request.data))
        with told("x"):
            seen = SeenAt(camera, wanted["x"], wanted["y"])
            changed = kept.put_click(found, point, seen, caller(request))
        return Response(checks.one(found, changed, point))

    @extend_schema(
        operation_id="remove_kept_click",
        summary="Take a click of a kept point away",
        description="Refused where fewer than two would be left.",
        responses=answers(200, OneKeptShape, WRITES),
    )
    def delete(self, request: Request, desk: str, point: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        with told("camera"):
            changed = kept.remove_click(found, point, camera, caller(request))
        return Response(checks.one(found, changed, point))
