"""Layers and text files measured by each other, and workers by their fellows."""

from __future__ import annotations

from typing import Any

from django.http import Http404
from django.utils.translation import gettext as _
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiExample, OpenApiResponse, extend_schema
from rest_framework import serializers
from rest_framework.generics import GenericAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.parsing import BoundedMultiPartParser
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import (
    ASKS,
    WRITES,
    Pages,
    StaffView,
    answers,
    asked,
    dataset_or_404,
    invalid,
    layer_named,
)
from gtm_hit.api.datasets.importing import FiniteField, refused
from gtm_hit.formats.problems import FormatError
from gtm_hit.metrics.annotations import MetricsError
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.models import ApiToken
from gtm_hit.ops.access.roles import SEES, Role
from gtm_hit.ops.quality import agreement, comparing, text_files
from gtm_hit.ops.quality.comparing import LARGEST_RADIUS, Scope
from gtm_hit.ops.quality.layer_rows import QualityError

EVALUATION = OpenApiExample(
    "a tracker by the truth",
    {
        "radius": 0.5,
        "frames": 400,
        "moda": 0.867,
        "modp": 0.777,
        "precision": 0.943,
        "recall": 0.923,
        "idf1": 0.842,
        "hota": 0.618,
        "curve": [{"radius": 0.05, "moda": -0.2, "modp": 0.41, "precision": 0.41, "recall": 0.39}],
    },
)


class EvaluationQuery(serializers.Serializer[Any]):
    truth = serializers.CharField(max_length=120, help_text="name of a layer")
    found = serializers.CharField(max_length=120, help_text="name of a layer")
    radius = serializers.FloatField(
        min_value=0.001, max_value=LARGEST_RADIUS, default=RADIUS, help_text="metres"
    )
    scope = serializers.ChoiceField(choices=[each.value for each in Scope], default=Scope.BOTH.value)
    start = serializers.IntegerField(
        min_value=0, max_value=LARGEST, default=0, help_text="frame number from which on to compare"
    )


class AgreementQuery(serializers.Serializer[Any]):
    radius = serializers.FloatField(
        min_value=0.001, max_value=LARGEST_RADIUS, default=RADIUS, help_text="metres"
    )


def compared(request: Request, slug: str) -> comparing.Comparison:
    dataset = dataset_or_404(slug)
    wanted = asked(request, EvaluationQuery)
    truth, found = (layer_named(request, dataset, wanted[side], side) for side in ("truth", "found"))
    scope = comparing.Scope(wanted["scope"])
    try:
        return comparing.compare(
            truth, found, wanted["radius"], scope, wanted["start"], comparing.MOST_FRAMES
        )
    except QualityError as error:
        raise invalid("", error) from error


class Evaluation(StaffView):
    @extend_schema(
        operation_id="evaluation",
        summary="One layer measured by another",
        description=f"{comparing.MOST_FRAMES} frames from `start` on. Scores as fractions; undefined: null.",
        parameters=[EvaluationQuery],
        responses=answers(200, OpenApiResponse(OpenApiTypes.OBJECT, examples=[EVALUATION]), ASKS),
    )
    def get(self, request: Request, slug: str) -> Response:
        return Response(comparing.as_numbers(compared(request, slug)))


class FrameScoresSerializer(serializers.Serializer[Any]):
    frame = serializers.IntegerField(help_text="frame number")
    truth = serializers.IntegerField(help_text="annotations of the truth")
    found = serializers.IntegerField()
    matched = serializers.IntegerField()
    missed = serializers.IntegerField()
    extra = serializers.IntegerField()
    swapped = serializers.IntegerField()
    moda = serializers.FloatField(allow_null=True)
    modp = serializers.FloatField(allow_null=True)
    precision = serializers.FloatField(allow_null=True)
    recall = serializers.FloatField(allow_null=True)


class ListView(StaffView, GenericAPIView[Any]):
    """Lists that come out of a calculation."""

    pagination_class = Pages

    def page(self, rows: Any) -> list[Any]:
        found = self.paginate_queryset(rows)
        assert found is not None
        return list(found)


class EvaluationFrames(ListView):
    serializer_class = FrameScoresSerializer

    @extend_schema(
        operation_id="evaluation_frames",
        summary="Frames of an evaluation, the worst first",
        parameters=[EvaluationQuery],
        responses=answers(200, FrameScoresSerializer(many=True), ASKS),
    )
    def get(self, request: Request, slug: str) -> Response:
        return self.get_paginated_response(self.page(comparing.frame_lines(compared(request, slug))))


class MarkPersonSerializer(serializers.Serializer[Any]):
    person = serializers.IntegerField()
    position = serializers.IntegerField()
    height = serializers.FloatField(allow_null=True, help_text="metres; null: the dataset's cylinder")
    radius = serializers.FloatField(allow_null=True, help_text="metres; null: the dataset's cylinder")


class MarkSerializer(serializers.Serializer[Any]):
    kind = serializers.ChoiceField(choices=[kind.value for kind in comparing.Kind])
    truth = MarkPersonSerializer(allow_null=True)
    found = MarkPersonSerializer(allow_null=True)
    distance = serializers.FloatField(allow_null=True, help_text="metres")
    before = serializers.IntegerField(
        allow_null=True, help_text="the number a swapped person was found under last"
    )


class MarksSerializer(serializers.Serializer[Any]):
    number = serializers.IntegerField(help_text="frame number")
    marks = MarkSerializer(many=True)


class EvaluationFrame(StaffView):
    @extend_schema(
        operation_id="evaluation_frame",
        summary="Who is matched, missed, extra or swapped in a frame",
        parameters=[EvaluationQuery],
        responses=answers(200, MarksSerializer, ASKS),
    )
    def get(self, request: Request, slug: str, number: int) -> Response:
        comparison = compared(request, slug)
        if number not in comparison.numbers.tolist():
            raise Http404
        marks = [comparing.mark_part(comparison, mark) for mark in comparing.marks(comparison, number)]
        return Response({"number": number, "marks": marks})


class TextFilesParser(BoundedMultiPartParser):
    def most_bytes(self) -> int:
        return 2 * text_files.MOST_UPLOADED


class TextFilesSerializer(serializers.Serializer[Any]):
    truth = serializers.FileField(help_text="`frame column row` lines", allow_empty_file=True)
    found = serializers.FileField(help_text="`frame column row` lines", allow_empty_file=True)
    step = FiniteField(help_text="metres between neighbouring positions")
    radius = FiniteField(default=RADIUS, help_text="metres")
    identities = serializers.BooleanField(default=False, help_text="lines are `frame column row person`")
    curve = serializers.BooleanField(default=False, help_text="add the scores at radii from 5 cm to 1 m")

    def validate(self, given: dict[str, Any]) -> dict[str, Any]:
        for side in ("truth", "found"):
            if given[side].size > text_files.MOST_UPLOADED:
                reason = _("The file is larger than %(size)d MB.") % {
                    "size": text_files.MOST_UPLOADED // 1_000_000
                }
                raise invalid(side, reason)
        return given


class TextFiles(StaffView):
    parser_classes = [TextFilesParser]
    # Nothing is written: the files are measured and forgotten.
    write_role = SEES
    write_scope = ApiToken.Scope.READ

    @extend_schema(
        operation_id="evaluate_files",
        summary="Two text files of positions measured by each other",
        description="As `manage.py evaluate` does. Scores as fractions; undefined: null.",
        request={"multipart/form-data": TextFilesSerializer},
        responses=answers(200, OpenApiResponse(OpenApiTypes.OBJECT, examples=[EVALUATION]), WRITES),
    )
    def post(self, request: Request) -> Response:
        wanted = valid(TextFilesSerializer(data=request.data))
        try:
            return Response(text_files.evaluate_uploads(**wanted))
        except MetricsError as error:
            raise invalid("", error) from error
        except FormatError as error:
            raise refused("", error) from error


class PairSerializer(serializers.Serializer[Any]):
    matched = serializers.IntegerField()
    matched_share = serializers.FloatField(allow_null=True)
    median_distance = serializers.FloatField(allow_null=True, help_text="metres")
    p95_distance = serializers.FloatField(allow_null=True, help_text="metres")
    identity_agreement = serializers.FloatField(allow_null=True)


class WorkersPairSerializer(PairSerializer):
    workers = serializers.ListField(child=serializers.CharField(), help_text="two pseudonyms")


class BiasSerializer(serializers.Serializer[Any]):
    annotations = serializers.IntegerField()
    confirmed = serializers.IntegerField(help_text="annotations somebody else has, too")
    bias_x = serializers.FloatField(allow_null=True, help_text="metres")
    bias_y = serializers.FloatField(allow_null=True, help_text="metres")
    spread_x = serializers.FloatField(allow_null=True, help_text="metres")
    spread_y = serializers.FloatField(allow_null=True, help_text="metres")


class BatchAgreementSerializer(PairSerializer):
    batch = serializers.IntegerField()
    pairs = WorkersPairSerializer(many=True)
    workers = serializers.DictField(child=BiasSerializer(), help_text="by pseudonym")


class Agreement(ListView):
    read_role = Role.REVIEWER
    serializer_class = BatchAgreementSerializer

    @extend_schema(
        operation_id="agreement",
        summary="How far workers who did the same batch agree",
        parameters=[AgreementQuery],
        responses=answers(200, BatchAgreementSerializer(many=True), ASKS),
    )
    def get(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        radius = asked(request, AgreementQuery)["radius"]
        numbers = self.page(agreement.shared_batches(dataset))
        found = agreement.batch_agreements(dataset, numbers, radius)
        return self.get_paginated_response([agreement.as_numbers(each) for each in found])
