"""Workers of a campaign by score, and its submitted assignments by suspicion."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.campaigns import campaign_or_404
from gtm_hit.api.common.staff import READS, WRITES, Conflict, ManagersView, Pages, answers
from gtm_hit.models import Assignment, WorkerScore
from gtm_hit.ops.scores import listing, words
from gtm_hit.ops.scores.suspicion import by_suspicion


class ScoreShape(serializers.ModelSerializer[WorkerScore]):
    worker = serializers.CharField(source="worker.pseudonym", help_text="pseudonym")
    why = serializers.SerializerMethodField()

    class Meta:
        model = WorkerScore
        fields = ["worker", "score", "low", "high", "assignments", "reasons", "why", "computed_at"]

    def get_why(self, row: WorkerScore) -> list[str]:
        return words.of_score(row)


class SuspicionShape(serializers.ModelSerializer[Assignment]):
    batch = serializers.IntegerField(source="batch.number")
    copy = serializers.IntegerField(source="batch.copy")
    worker = serializers.CharField(source="worker.pseudonym", help_text="pseudonym")
    layer = serializers.CharField(source="layer.name")
    suspicion = serializers.FloatField(
        source="score.suspicion", default=None, help_text="0 to 1; null: not measured yet"
    )
    why = serializers.SerializerMethodField()

    class Meta:
        model = Assignment
        fields = ["id", "batch", "copy", "worker", "state", "layer", "submitted_at", "suspicion", "why"]

    def get_why(self, row: Assignment) -> list[str]:
        score = getattr(row, "score", None)
        return words.of_suspicion(score) if score else []


class MeasuredSerializer(serializers.Serializer[Any]):
    assignments = serializers.IntegerField(help_text="measured anew")


class Scores(ManagersView, ListAPIView[WorkerScore]):
    queryset = WorkerScore.objects.none()
    serializer_class = ScoreShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[WorkerScore]:
        return listing.workers(campaign_or_404(self.kwargs["slug"], self.kwargs["name"]))

    @extend_schema(
        operation_id="scores",
        summary="Workers by score, lowest first",
        responses=answers(200, ScoreShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)

    @extend_schema(
        operation_id="recompute_scores",
        summary="Measure a small campaign anew",
        request=None,
        responses=answers(200, MeasuredSerializer, WRITES),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        try:
            return Response({"assignments": listing.recompute_now(campaign_or_404(slug, name))})
        except listing.TooMuch as error:
            raise Conflict(str(error)) from error


class SuspiciousAssignments(ManagersView, ListAPIView[Assignment]):
    queryset = Assignment.objects.none()
    serializer_class = SuspicionShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Assignment]:
        return by_suspicion(campaign_or_404(self.kwargs["slug"], self.kwargs["name"]))

    @extend_schema(
        operation_id="suspicion",
        summary="Submitted assignments, most suspicious first",
        responses=answers(200, SuspicionShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)
