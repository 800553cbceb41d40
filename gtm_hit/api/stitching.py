"""Accepted batches into ground truth, and what people are asked about."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from django.db.models import QuerySet
from django.http import Http404
from drf_spectacular.utils import OpenApiExample, extend_schema
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import refusal, valid
from gtm_hit.api.common.staff import (
    ASKS,
    READS,
    WRITES,
    Conflict,
    Pages,
    ReviewersView,
    StaffView,
    answers,
    asked,
    caller,
    dataset_or_404,
    invalid,
)
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.models import ApiToken, StitchConflict
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.stitching import conflicts, overview, running, showing
from gtm_hit.ops.stitching.scope import Scope, StitchingError, named


class CampaignQuery(serializers.Serializer[Any]):
    campaign = serializers.CharField(
        max_length=120, default="", allow_blank=True, help_text="its name; without: batches of no campaign"
    )


class ConflictsQuery(CampaignQuery):
    state = serializers.ChoiceField(choices=StitchConflict.State.choices, required=False)


class StartSerializer(CampaignQuery):
    gate = serializers.FloatField(default=running.Asked.gate, help_text="metres, in common frames")
    gap = serializers.IntegerField(default=running.Asked.gap, help_text="frames", max_value=10_000)
    margin = serializers.FloatField(default=running.Asked.margin, help_text="log odds")
    return_seconds = serializers.FloatField(default=running.Asked.return_seconds)
    return_reach = serializers.FloatField(default=running.Asked.return_reach, help_text="metres")


class StitchDecisionSerializer(serializers.Serializer[Any]):
    decision = serializers.ChoiceField(choices=StitchConflict.Decision.choices)


class StitchingShape(serializers.Serializer[Any]):
    layer = serializers.CharField(allow_null=True, help_text="null before the first run")
    accepted = serializers.IntegerField(help_text="assignments")
    frames = serializers.IntegerField()
    covered = serializers.IntegerField(help_text="frames in accepted batches")
    in_layer = serializers.IntegerField(help_text="frames in the layer")
    open = serializers.IntegerField(help_text="conflicts")
    decided = serializers.IntegerField(help_text="conflicts")
    decided_since = serializers.IntegerField(help_text="conflicts decided since the last run")
    rules = serializers.DictField(allow_null=True)
    numbers = serializers.DictField(allow_null=True, help_text="what came out of the last run")


class ConflictShape(serializers.ModelSerializer[StitchConflict]):
    decided_by = serializers.CharField(source="decided_by.username", default=None, allow_null=True)

    class Meta:
        model = StitchConflict
        fields = [
            *("id", "kind", "left_at", "came_at", "metres", "seconds", "lead", "state", "decision"),
            *("decided_by", "decided_at"),
        ]


class PlaceShape(serializers.Serializer[Any]):
    frame = serializers.IntegerField()
    x = serializers.FloatField(help_text="metres")
    y = serializers.FloatField(help_text="metres")


class BoxShape(serializers.Serializer[Any]):
    side = serializers.ChoiceField(choices=[showing.BEFORE, showing.AFTER])
    box = serializers.ListField(child=serializers.IntegerField(), help_text="pixels")


class PictureShape(serializers.Serializer[Any]):
    frame = serializers.IntegerField()
    camera = serializers.CharField()
    width = serializers.IntegerField()
    height = serializers.IntegerField()
    light = serializers.CharField(help_text="digest of the picture that fills a pane")
    full = serializers.CharField(help_text="digest of the picture with every pixel")
    boxes = BoxShape(many=True)


class DetailShape(ConflictShape):
    before = PlaceShape(many=True)
    after = PlaceShape(many=True)
    others = serializers.ListField(child=PlaceShape(many=True))
    pictures = serializers.ListField(child=PictureShape(many=True))

    class Meta(ConflictShape.Meta):
        fields = [*ConflictShape.Meta.fields, "before", "after", "others", "pictures"]


class Undecided(Conflict):
    default_code = "not_as_it_was"


DECIDES = {**WRITES, 409: refusal("not_as_it_was; somebody else has decided meanwhile")}


def scope_or_400(slug: str, campaign: str) -> Scope:
    dataset = dataset_or_404(slug)
    try:
        return named(dataset, campaign)
    except StitchingError as error:
        raise invalid("campaign", error) from error


def conflict_or_404(slug: str, pk: int) -> StitchConflict:
    found = StitchConflict.objects.filter(pk=pk, stitching__dataset__slug=slug)
    conflict = found.select_related("stitching__dataset", "decided_by").first()
    if conflict is None:
        raise Http404
    return conflict


class Stitching(StaffView):
    read_role = Role.REVIEWER
    write_role = Role.MANAGER
    write_scope = ApiToken.Scope.WORK

    @extend_schema(
        operation_id="stitching",
        summary="How far the ground truth is",
        parameters=[CampaignQuery],
        responses=answers(200, StitchingShape, ASKS),
    )
    def get(self, request: Request, slug: str) -> Response:
        found = overview.overview(scope_or_400(slug, asked(request, CampaignQuery)["campaign"]))
        shown = {
            "layer": found.stitching.layer.name if found.stitching else None,
            **{name: getattr(found, name) for name in ("accepted", "frames", "covered", "in_layer", "open")},
            "decided": found.decided,
            "decided_since": found.decided_since,
            "rules": found.run.rules if found.run else None,
            "numbers": found.run.numbers if found.run else None,
        }
        return Response(StitchingShape(shown).data)

    @extend_schema(
        operation_id="start_stitching",
        summary="Make or renew the ground-truth layer of accepted batches",
        description="Answers with the job. Running again changes only what changed.",
        request=StartSerializer,
        responses=answers(202, JobShape, WRITES),
        examples=[OpenApiExample("a campaign", {"campaign": "autumn", "gap": 5}, request_only=True)],
    )
    def post(self, request: Request, slug: str) -> Response:
        wanted = valid(StartSerializer(data=request.data))
        scope = scope_or_400(slug, wanted.pop("campaign"))
        try:
            return started(running.start(scope, running.Asked(**wanted), caller(request)))
        except StitchingError as error:
            raise invalid("", error) from error


class Conflicts(ReviewersView, ListAPIView[StitchConflict]):
    queryset = StitchConflict.objects.none()
    serializer_class = ConflictShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[StitchConflict]:
        wanted = asked(self.request, ConflictsQuery)
        scope = scope_or_400(self.kwargs["slug"], wanted["campaign"])
        return overview.conflicts(scope, wanted.get("state", ""))

    @extend_schema(
        operation_id="stitch_conflicts",
        summary="Who may be the same person",
        parameters=[ConflictsQuery],
        responses=answers(200, ConflictShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class OneConflict(ReviewersView):
    @extend_schema(
        operation_id="stitch_conflict",
        summary="Both sides on the ground and in the pictures",
        responses=answers(200, DetailShape, READS),
    )
    def get(self, request: Request, slug: str, pk: int) -> Response:
        conflict = conflict_or_404(slug, pk)
        # `before` and `after` are the annotations' names on the row, and paths here.
        return Response(ConflictShape(conflict).data | asdict(showing.detail(conflict)))


class DecideConflict(ReviewersView):
    @extend_schema(
        operation_id="decide_stitch_conflict",
        summary="The same person, or two",
        description="Remembered; the next run puts it into the layer.",
        request=StitchDecisionSerializer,
        responses=answers(200, ConflictShape, DECIDES),
    )
    def post(self, request: Request, slug: str, pk: int) -> Response:
        conflict = conflict_or_404(slug, pk)
        wanted = valid(StitchDecisionSerializer(data=request.data))
        try:
            decided = conflicts.decide(conflict, wanted["decision"], caller(request))
        except StitchingError as error:
            raise Undecided(str(error)) from error
        return Response(ConflictShape(decided).data)


class UndoConflict(ReviewersView):
    @extend_schema(
        operation_id="undo_stitch_conflict",
        summary="Take a decision back",
        request=None,
        responses=answers(200, ConflictShape, DECIDES),
    )
    def post(self, request: Request, slug: str, pk: int) -> Response:
        try:
            return Response(ConflictShape(conflicts.undo(conflict_or_404(slug, pk))).data)
        except StitchingError as error:
            raise Undecided(str(error)) from error
