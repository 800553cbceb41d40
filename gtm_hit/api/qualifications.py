"""Qualifications of a dataset: made, tried, granted, revoked."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import (
    READS,
    WRITES,
    ManagersView,
    Pages,
    answers,
    caller,
    dataset_or_404,
    invalid,
    layer_named,
    named_or_404,
)
from gtm_hit.models import Qualification, QualificationAttempt, QualificationGrant
from gtm_hit.ops.qualifications import grants, managing
from gtm_hit.ops.qualifications.managing import Order, PassMarks, QualificationError

SHARE: dict[str, Any] = {"min_value": 0.0, "max_value": 1.0}
METRES: dict[str, Any] = {"min_value": 0.01, "max_value": 0.5, "help_text": "metres"}

MARKS = tuple(vars(PassMarks()))


class MarksSerializer(serializers.Serializer[Any]):
    min_recall = serializers.FloatField(default=PassMarks.min_recall, **SHARE)
    min_precision = serializers.FloatField(default=PassMarks.min_precision, **SHARE)
    max_median = serializers.FloatField(default=PassMarks.max_median, **METRES)
    max_p95 = serializers.FloatField(default=PassMarks.max_p95, **METRES)
    min_idf1 = serializers.FloatField(default=PassMarks.min_idf1, **SHARE)


class NewQualificationSerializer(MarksSerializer):
    name = serializers.CharField(max_length=120)
    title = serializers.CharField(max_length=200, default="", allow_blank=True, help_text="what workers read")
    truth = serializers.CharField(max_length=120, help_text="name of a layer")
    first_frame = serializers.IntegerField(min_value=0, max_value=LARGEST, default=0, help_text="number")
    frames_per_try = serializers.IntegerField(min_value=1, max_value=100, default=5)
    tries = serializers.IntegerField(min_value=1, max_value=100, default=2)


class QualificationShape(serializers.ModelSerializer[Qualification]):
    truth = serializers.CharField(source="truth.name")
    tried = serializers.IntegerField(help_text="tries that were judged")
    passed = serializers.IntegerField()
    waiting = serializers.IntegerField(help_text="tries not submitted yet")

    class Meta:
        model = Qualification
        fields = [
            *("name", "title", "truth", "frames_per_try", "tries", *MARKS),
            *("closed_at", "tried", "passed", "waiting"),
        ]


class GrantShape(serializers.ModelSerializer[QualificationGrant]):
    worker = serializers.CharField(source="worker.pseudonym", help_text="pseudonym")
    by = serializers.CharField(source="by.username", default=None, help_text="null: by a passed try")

    class Meta:
        model = QualificationGrant
        fields = ["worker", "granted", "by", "why", "at"]


class TryShape(serializers.ModelSerializer[QualificationAttempt]):
    worker = serializers.CharField(source="worker.pseudonym", help_text="pseudonym")
    layer = serializers.CharField(source="assignment.layer.name")

    class Meta:
        model = QualificationAttempt
        fields = ["worker", "number", "passed", "result", "started_at", "scored_at", "layer"]


class GrantSerializer(serializers.Serializer[Any]):
    worker = serializers.CharField(max_length=20, help_text="pseudonym")
    granted = serializers.BooleanField(help_text="false: revoked, which takes a reason")
    why = serializers.CharField(max_length=500, default="", allow_blank=True)


class Qualifications(ManagersView):
    @extend_schema(
        operation_id="qualifications",
        summary="Qualifications of a dataset",
        responses=answers(200, QualificationShape(many=True), READS),
    )
    def get(self, request: Request, slug: str) -> Response:
        found = managing.qualifications(dataset_or_404(slug))
        return Response(QualificationShape(found, many=True).data)

    @extend_schema(
        operation_id="make_qualification",
        summary="Make a qualification out of frames whose truth is known",
        request=NewQualificationSerializer,
        responses=answers(201, QualificationShape, WRITES),
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(NewQualificationSerializer(data=request.data))
        marks = PassMarks(**{name: wanted.pop(name) for name in MARKS})
        truth = layer_named(request, dataset, wanted.pop("truth"), "truth")
        try:
            made = managing.create(dataset, Order(truth=truth, marks=marks, **wanted), caller(request))
        except QualificationError as error:
            raise invalid("", error) from error
        found = managing.qualifications(dataset).get(pk=made.pk)
        return Response(QualificationShape(found).data, status=201)


class Grants(ManagersView, ListAPIView[QualificationGrant]):
    queryset = QualificationGrant.objects.none()
    serializer_class = GrantShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[QualificationGrant]:
        return grants.standing(one_or_404(self.kwargs["slug"], self.kwargs["name"]))

    @extend_schema(
        operation_id="grants",
        summary="Who has a qualification, or lost it",
        responses=answers(200, GrantShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)

    @extend_schema(
        operation_id="decide_qualification",
        summary="Grant a qualification by hand, or revoke it",
        request=GrantSerializer,
        responses=answers(200, GrantShape, WRITES),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        qualification = one_or_404(slug, name)
        wanted = valid(GrantSerializer(data=request.data))
        try:
            worker = grants.worker_named(wanted["worker"])
        except QualificationError as error:
            raise invalid("worker", error) from error
        decide = grants.grant if wanted["granted"] else grants.revoke
        try:
            made = decide(qualification, worker, caller(request), wanted["why"])
        except QualificationError as error:
            raise invalid("", error) from error
        return Response(GrantShape(made).data)


class Tries(ManagersView, ListAPIView[QualificationAttempt]):
    queryset = QualificationAttempt.objects.none()
    serializer_class = TryShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[QualificationAttempt]:
        return managing.tries(one_or_404(self.kwargs["slug"], self.kwargs["name"]))

    @extend_schema(
        operation_id="tries",
        summary="Tries of a qualification and what came out, newest first",
        responses=answers(200, TryShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


def one_or_404(slug: str, name: str) -> Qualification:
    return named_or_404(Qualification.objects.filter(dataset__slug=slug), name)
