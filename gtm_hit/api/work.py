"""Batches, who has them, and how far they are."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from django.db.models import QuerySet
from django.urls import reverse
from drf_spectacular.utils import OpenApiExample, extend_schema
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import (
    ASKS,
    READS,
    WRITES,
    Pages,
    StaffView,
    answers,
    asked,
    dataset_or_404,
    invalid,
)
from gtm_hit.models import ApiToken, Assignment, Batch, Dataset
from gtm_hit.ops import overview
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.work import batches, entry_links, links, workers


class BatchShape(serializers.ModelSerializer[Batch]):
    frames = serializers.IntegerField(source="frame_count")
    first_number = serializers.IntegerField(help_text="frame number")
    last_number = serializers.IntegerField(help_text="frame number")

    class Meta:
        model = Batch
        fields = ["number", "copy", "frames", "first_number", "last_number", "created_at"]


class ProgressSerializer(serializers.Serializer[Any]):
    batches = serializers.IntegerField()
    free = serializers.IntegerField()
    leased = serializers.IntegerField()
    submitted = serializers.IntegerField()
    accepted = serializers.IntegerField()
    frames_without = serializers.IntegerField(help_text="frames in no batch")


class AssignmentShape(serializers.ModelSerializer[Assignment]):
    batch = serializers.IntegerField(source="batch.number")
    copy = serializers.IntegerField(source="batch.copy")
    worker = serializers.CharField(source="worker.pseudonym", help_text="pseudonym")
    layer = serializers.CharField(source="layer.name")
    frames = serializers.IntegerField(source="frame_count")
    frames_done = serializers.IntegerField()
    people = serializers.IntegerField()

    class Meta:
        model = Assignment
        fields = [
            *("id", "batch", "copy", "worker", "layer", "state", "frames", "frames_done", "people"),
            *("leased_at", "expires_at", "submitted_at"),
        ]


class BatchesQuery(serializers.Serializer[Any]):
    copy = serializers.IntegerField(min_value=1, max_value=LARGEST, required=False)


class AssignmentsQuery(serializers.Serializer[Any]):
    state = serializers.ChoiceField(choices=Assignment.State.choices, required=False)
    worker = serializers.CharField(max_length=20, required=False, help_text="pseudonym")
    batch = serializers.IntegerField(min_value=1, max_value=LARGEST, required=False)


class MakeBatchesSerializer(serializers.Serializer[Any]):
    size = serializers.IntegerField(min_value=1, max_value=batches.MAX_SIZE, default=10, help_text="frames")
    copies = serializers.IntegerField(
        min_value=1, max_value=batches.MAX_COPIES, default=1, help_text="independent annotations of a batch"
    )


class BatchesMadeSerializer(serializers.Serializer[Any]):
    made = serializers.IntegerField(help_text="batches added by this request")


class Batches(StaffView, ListAPIView[Batch]):
    queryset = Batch.objects.none()
    serializer_class = BatchShape
    pagination_class = Pages
    write_role = Role.MANAGER
    write_scope = ApiToken.Scope.WORK

    def get_queryset(self) -> QuerySet[Batch]:
        wanted = asked(self.request, BatchesQuery)
        return overview.batches(dataset_or_404(self.kwargs["slug"])).filter(**wanted)

    @extend_schema(
        operation_id="batches",
        summary="Batches of a dataset",
        parameters=[BatchesQuery],
        responses=answers(200, BatchShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)

    @extend_schema(
        operation_id="make_batches",
        summary="Batch the frames that are in no batch yet",
        description="The same again makes nothing: existing batches stay as they are.",
        request=MakeBatchesSerializer,
        responses=answers(200, BatchesMadeSerializer, WRITES),
        examples=[OpenApiExample("ten frames, done twice", {"size": 10, "copies": 2}, request_only=True)],
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(MakeBatchesSerializer(data=request.data))
        try:
            return Response({"made": batches.make_batches(dataset, **wanted)})
        except batches.BatchError as error:
            raise invalid("", error) from error


class LinkQuery(serializers.Serializer[Any]):
    worker = serializers.CharField(
        max_length=workers.MAX_ID,
        required=False,
        help_text="a worker's id; the link is this worker's own then",
    )
    platform = serializers.CharField(max_length=workers.MAX_PLATFORM, default="link")


class LinkSerializer(serializers.Serializer[Any]):
    link = serializers.URLField(help_text="valid until it is closed or the server's key changes")
    closed = serializers.BooleanField(help_text="nobody new is let in by it; personal links are never closed")


class SwitchSerializer(serializers.Serializer[Any]):
    closed = StrictBooleanField(help_text="false: makes a new link, if it was closed")
    platform = serializers.CharField(max_length=workers.MAX_PLATFORM, default="link")


class Link(StaffView):
    read_role = Role.MANAGER
    write_role = Role.MANAGER
    # A link lets workers in, and that is more than reading.
    read_scope = ApiToken.Scope.WORK
    write_scope = ApiToken.Scope.WORK

    @extend_schema(
        operation_id="link",
        summary="The link that lets workers into a dataset, or one worker's own",
        parameters=[LinkQuery],
        responses=answers(200, LinkSerializer, ASKS),
    )
    def get(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = asked(request, LinkQuery)
        try:
            platform = workers.clean_platform(wanted["platform"])
            external_id = workers.clean_external_id(wanted["worker"]) if "worker" in wanted else None
        except workers.InvalidWorkerId as error:
            raise invalid("", error) from error
        return self.answer(request, dataset, platform, external_id)

    @extend_schema(
        operation_id="switch_link",
        summary="Close the link that lets workers in, or make a new one",
        description="Whoever works already goes on.",
        request=SwitchSerializer,
        responses=answers(200, LinkSerializer, WRITES),
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(SwitchSerializer(data=request.data))
        try:
            platform = workers.clean_platform(wanted["platform"])
        except workers.InvalidWorkerId as error:
            raise invalid("platform", error) from error
        (entry_links.close if wanted["closed"] else entry_links.reopen)(dataset, platform)
        return self.answer(request, dataset, platform)

    def answer(
        self, request: Request, dataset: Dataset, platform: str, external_id: str | None = None
    ) -> Response:
        token = links.entry_token(dataset, platform, external_id)
        link = request.build_absolute_uri(reverse("join", args=[token]))
        return Response({"link": link, "closed": links.read_entry(token).closed})


class Progress(StaffView):
    @extend_schema(
        operation_id="progress",
        summary="How many batches are free, leased, submitted, accepted",
        responses=answers(200, ProgressSerializer, READS),
    )
    def get(self, request: Request, slug: str) -> Response:
        return Response(asdict(overview.batch_counts(dataset_or_404(slug))))


class Assignments(StaffView, ListAPIView[Assignment]):
    read_role = Role.REVIEWER
    queryset = Assignment.objects.none()
    serializer_class = AssignmentShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Assignment]:
        wanted = asked(self.request, AssignmentsQuery)
        names = {"state": "state", "worker": "worker__pseudonym", "batch": "batch__number"}
        narrowed = {names[name]: value for name, value in wanted.items()}
        return overview.assignments(dataset_or_404(self.kwargs["slug"])).filter(**narrowed)

    @extend_schema(
        operation_id="assignments",
        summary="Who has which batch, and how far",
        description="Workers appear by their pseudonyms.",
        parameters=[AssignmentsQuery],
        responses=answers(200, AssignmentShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)
