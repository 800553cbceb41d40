"""All cameras and points of a desk adjusted at once."""

from __future__ import annotations

from typing import Any

from django.http import HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import ASKS, READS, WRITES, answers, caller
from gtm_hit.api.datasets.importing import FiniteField
from gtm_hit.api.desk.common import DeskFileParser, DeskView, desk_or_404, told
from gtm_hit.api.desk.ground import StepsShape
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.formats.calibration.pos_file import Numbering
from gtm_hit.models import ClickDecision
from gtm_hit.ops.desk import (
    adjust_choices,
    adjust_decisions,
    adjust_files,
    adjust_job,
    adjust_results,
    adjust_view,
)
from gtm_hit.ops.desk.adjust_choices import Choices

UNITS = ["m", "cm", "mm"]
NUMBERINGS = {"": None, "0": Numbering.FROM_ZERO, "1": Numbering.FROM_ONE}


class AdjustSerializer(serializers.Serializer[Any]):
    variant = serializers.ChoiceField(choices=adjust_choices.VARIANTS, default=Choices.variant)
    turn = FiniteField(default=Choices.turn, help_text="pixels from which a miss counts less (Huber)")
    ground_weight = FiniteField(
        default=None, allow_null=True, help_text="of a measured point's click; null: together as all others"
    )
    ground_sigma = FiniteField(default=0.0, help_text="metres measured points may be off; 0: not at all")
    hold = serializers.ListField(
        child=serializers.CharField(max_length=200),
        default=list,
        max_length=200,
        help_text="CAMERA:WHAT, which is pose, lens, or parameters such as fx,k3",
    )


class ClickDecisionSerializer(serializers.Serializer[Any]):
    source = serializers.CharField(  # type: ignore[assignment]
        max_length=64, help_text="ground, kept, or the digest of a file of clicks"
    )
    point = serializers.CharField(max_length=200)
    camera = serializers.CharField(max_length=80)
    decision = serializers.ChoiceField(
        choices=ClickDecision.Decision.choices, allow_blank=True, help_text="empty: undecided again"
    )


class ClickFileSerializer(serializers.Serializer[Any]):
    file = serializers.FileField(help_text="a zip of CAMERA/FRAME.pos, or a ba_problem.txt")
    unit = serializers.ChoiceField(choices=UNITS, default="cm", help_text="of a ba_problem.txt")
    feet = serializers.ChoiceField(
        choices=[each for each in NUMBERINGS if each],
        default="",
        allow_blank=True,
        help_text="the number .pos files give feet; empty: as their numbers tell",
    )


class SharedShape(serializers.Serializer[Any]):
    cameras = serializers.ListField(child=serializers.CharField())
    points = serializers.ListField(
        child=serializers.ListField(child=serializers.IntegerField()),
        help_text="that each two cameras see; on the diagonal, that each one shares with any other",
    )
    measured = serializers.ListField(child=serializers.IntegerField(), help_text="that each camera sees")
    free = serializers.IntegerField(help_text="points that two cameras or more see")


class AdjustBriefShape(serializers.Serializer[Any]):
    number = serializers.IntegerField()
    created_at = serializers.DateTimeField()
    choices = serializers.DictField(help_text="what it was asked for with")
    cost = serializers.FloatField()
    median_px = serializers.FloatField(allow_null=True)
    monotone = serializers.BooleanField(help_text="no lens folds inside its picture")


class ClickFileShape(serializers.Serializer[Any]):
    digest = serializers.CharField()
    name = serializers.CharField()
    points = serializers.IntegerField()


class UnusedClickShape(serializers.Serializer[Any]):
    source = serializers.CharField()  # type: ignore[assignment]
    point = serializers.CharField()
    camera = serializers.CharField()
    x = serializers.FloatField()
    y = serializers.FloatField()


class AdjustShape(StepsShape):
    problem = serializers.CharField(help_text="why it cannot be adjusted; empty: it can")
    fewest = serializers.IntegerField(help_text="shared points from which there is something to adjust")
    shared = SharedShape()
    files = ClickFileShape(many=True)
    dropped = UnusedClickShape(many=True)
    results = AdjustBriefShape(many=True, help_text="the newest first")
    in_use = serializers.IntegerField(allow_null=True, help_text="the result the cameras stand by")
    ended = serializers.ListField(
        child=serializers.CharField(), help_text="cameras that changed since, and stand by themselves"
    )


class WorstClickShape(serializers.Serializer[Any]):
    source = serializers.CharField()  # type: ignore[assignment]
    point = serializers.CharField()
    camera = serializers.CharField()
    x = serializers.FloatField(help_text="where it was clicked, pixels")
    y = serializers.FloatField()
    projected_x = serializers.FloatField(help_text="where the result has it")
    projected_y = serializers.FloatField()
    miss = serializers.FloatField(help_text="pixels")
    decision = serializers.CharField(help_text="keep, drop or none")
    moved = serializers.BooleanField(help_text="since the result")


class AdjustResultShape(AdjustBriefShape):
    report = serializers.DictField(help_text="before and after, as `calibrate adjust --json` has it")
    cameras = serializers.DictField(help_text="lens and pose of each camera, metres, world to camera")
    worst = WorstClickShape(many=True)
    since = serializers.ListField(child=serializers.CharField(), help_text="what has changed since, in words")


class Adjust(DeskView):
    @extend_schema(
        operation_id="desk_adjust",
        summary="How the cameras hang together, and results there are",
        responses=answers(200, AdjustShape, READS),
    )
    def get(self, request: Request, desk: str) -> Response:
        return Response(adjust_view.whole(desk_or_404(request, desk)))

    @extend_schema(
        operation_id="adjust_desk",
        summary="Adjust all cameras and points at once",
        description="The same clicks and choices go on where they were stopped, and find the same result.",
        request=AdjustSerializer,
        responses=answers(202, JobShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        given = valid(AdjustSerializer(data=request.data))
        with told("desk"):
            choices = Choices(**{**given, "hold": adjust_choices.holding(given["hold"])})
            return started(adjust_job.start(found, choices, caller(request)))


class OneAdjustment(DeskView):
    @extend_schema(
        operation_id="desk_adjust_result",
        summary="A result: before and after, the worst clicks, and what has changed since",
        responses=answers(200, AdjustResultShape, READS),
    )
    def get(self, request: Request, desk: str, result: int) -> Response:
        found = desk_or_404(request, desk)
        with told():
            return Response(adjust_view.result(found, adjust_results.result_of(found, result)))


class UseAdjustment(DeskView):
    @extend_schema(
        operation_id="use_desk_adjust_result",
        summary="Let all cameras stand where a result has them",
        description="Undone on the page `adjust`. It ends for a camera whose lens or ground clicks change.",
        request=None,
        responses=answers(200, AdjustShape, WRITES),
    )
    def post(self, request: Request, desk: str, result: int) -> Response:
        found = desk_or_404(request, desk)
        with told("result"):
            adjust_results.use(found, result, caller(request))
        return Response(adjust_view.whole(found))


class LeaveAdjustment(DeskView):
    @extend_schema(
        operation_id="leave_desk_adjust_result",
        summary="Let each camera stand by its own lens and clicks again",
        request=None,
        responses=answers(200, AdjustShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        with told("result"):
            adjust_results.go_back(found, caller(request))
        return Response(adjust_view.whole(found))


class DecideClick(DeskView):
    @extend_schema(
        operation_id="decide_desk_click",
        summary="Say that a click far off is right, or is not to be adjusted with",
        request=ClickDecisionSerializer,
        responses=answers(200, AdjustShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        given = valid(ClickDecisionSerializer(data=request.data))
        with told("point"):
            adjust_decisions.decide(found, **given, user=caller(request))
        return Response(adjust_view.whole(found))


class ClickFiles(DeskView):
    parser_classes = [DeskFileParser]

    @extend_schema(
        operation_id="put_desk_click_file",
        summary="Adjust with the clicks of a file, too",
        description="Of a ba_problem.txt, measured points and their clicks go to the ground.",
        request={"multipart/form-data": ClickFileSerializer},
        responses=answers(200, AdjustShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        given = valid(ClickFileSerializer(data=request.data))
        file, feet = given["file"], NUMBERINGS[given["feet"]]
        with told("file"):
            adjust_files.put_any(
                found, file.read(), file.name or "clicks", given["unit"], feet, caller(request)
            )
        return Response(adjust_view.whole(found))


class OneClickFile(DeskView):
    @extend_schema(
        operation_id="leave_desk_click_file",
        summary="Adjust without a file's clicks",
        responses=answers(200, AdjustShape, WRITES),
    )
    def delete(self, request: Request, desk: str, digest: str) -> Response:
        found = desk_or_404(request, desk)
        with told("digest"):
            adjust_files.stop_using(found, digest, caller(request))
        return Response(adjust_view.whole(found))


class DeskProblemFile(DeskView):
    @extend_schema(
        operation_id="desk_ba_problem",
        summary="Clicks and cameras as a ba_problem.txt",
        parameters=[OpenApiParameter("unit", str, enum=UNITS, description="of its lengths; cm")],
        responses={(200, "text/plain"): OpenApiTypes.STR, **ASKS},
    )
    def get(self, request: Request, desk: str) -> HttpResponse:
        found = desk_or_404(request, desk)
        unit = valid(_UnitSerializer(data=request.query_params))["unit"]
        with told("cameras"):
            text = adjust_files.problem_text(found, adjust_view.last_choices(found), unit)
        return HttpResponse(text, content_type="text/plain")


class DeskPosFiles(DeskView):
    @extend_schema(
        operation_id="desk_pos_files",
        summary="Feet and heads that files brought, as .pos files in a zip",
        responses={(200, "application/zip"): OpenApiTypes.BINARY, **ASKS},
    )
    def get(self, request: Request, desk: str) -> HttpResponse:
        with told("files"):
            data = adjust_files.pos_zip(desk_or_404(request, desk))
        return HttpResponse(data, content_type="application/zip")


class _UnitSerializer(serializers.Serializer[Any]):
    unit = serializers.ChoiceField(choices=UNITS, default="cm")
