"""What is told to a campaign's platform: planned, sent, decided by hand, and by files."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import Http404, HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.campaigns import ACTS, READS_REFUSED, campaign_or_404, refusals
from gtm_hit.api.common.fields import StrictBooleanField
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import ASKS, ManagersView, Pages, answers, asked, caller
from gtm_hit.api.jobs import Download, JobShape, started
from gtm_hit.models import Campaign, OutboxRow
from gtm_hit.ops.outbox import accounts, handover, overview, planning, return_requests, rows, sending

LARGEST_ROW = 2**63 - 1


class RowShape(serializers.ModelSerializer[OutboxRow]):
    worker = serializers.CharField(source="worker.pseudonym")
    planned_by = serializers.CharField(source="planned_by.username", allow_null=True, default=None)
    decided_by = serializers.CharField(source="decided_by.username", allow_null=True, default=None)

    class Meta:
        model = OutboxRow
        fields = [
            *("id", "kind", "state", "worker", "submission", "amount", "attempts", "error"),
            *("planned_at", "planned_by", "not_before", "sent_at", "done_at", "decided_by"),
        ]


class RowsQuery(serializers.Serializer[Any]):
    state = serializers.ChoiceField(choices=OutboxRow.State.choices, required=False)
    kind = serializers.ChoiceField(choices=OutboxRow.Kind.choices, required=False)


class PlannedShape(serializers.Serializer[Any]):
    """A row that is planned, or would be."""

    kind = serializers.ChoiceField(choices=OutboxRow.Kind.choices)
    worker = serializers.CharField(source="worker.pseudonym")
    submission = serializers.CharField()
    amount = serializers.DecimalField(max_digits=11, decimal_places=2)


class PayoutsSerializer(serializers.Serializer[Any]):
    dry_run = StrictBooleanField(help_text="true: tell what would be planned, and plan nothing")
    workers = serializers.ListField(
        child=serializers.CharField(max_length=20), max_length=1000, allow_null=True, default=None
    )


class ReturnRequestSerializer(serializers.Serializer[Any]):
    submission = serializers.CharField(max_length=120, help_text="the platform's id")
    reason = serializers.CharField(max_length=1000, help_text="what the worker reads")


class OutboxDecisionSerializer(serializers.Serializer[Any]):
    action = serializers.ChoiceField(
        choices=["retry", "withdraw", "happened", "not_happened"],
        help_text="retry what failed, withdraw what is planned, say what became of what is unclear",
    )


class HandedOverSerializer(serializers.Serializer[Any]):
    upto = serializers.IntegerField(min_value=0, max_value=LARGEST_ROW, help_text="last row of the file")


class DoneShape(serializers.Serializer[Any]):
    done = serializers.IntegerField(help_text="rows that are confirmed by it")


class SubmissionsSerializer(serializers.Serializer[Any]):
    csv = serializers.CharField(trim_whitespace=False, help_text="Prolific's list of submissions")


class SubmissionsShape(serializers.Serializer[Any]):
    lines = serializers.IntegerField()
    news = serializers.IntegerField(help_text="submissions whose status was not known")


class Outbox(ManagersView, ListAPIView[OutboxRow]):
    queryset = OutboxRow.objects.none()
    serializer_class = RowShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[OutboxRow]:
        wanted = asked(self.request, RowsQuery)
        campaign = campaign_or_404(self.kwargs["slug"], self.kwargs["name"])
        return overview.listed(campaign).filter(**wanted)

    @extend_schema(
        operation_id="outbox",
        summary="What is, was or shall be told to the platform",
        description="What needs a person first.",
        parameters=[RowsQuery],
        responses=answers(200, RowShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class Payouts(ManagersView):
    @extend_schema(
        operation_id="plan_payouts",
        summary="Plan to pay through the platform what is to be paid",
        request=PayoutsSerializer,
        responses=answers(200, PlannedShape(many=True), ACTS),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(PayoutsSerializer(data=request.data))
        with refusals():
            if wanted["dry_run"]:
                found = planning.preview(campaign, wanted["workers"])
            else:
                found = planning.plan_payouts(campaign, caller(request), wanted["workers"])
        return Response(PlannedShape(found, many=True).data)


class ReturnRequests(ManagersView):
    @extend_schema(
        operation_id="request_return",
        summary="Plan to ask a worker to give a submission back, unpaid and without a rejection",
        request=ReturnRequestSerializer,
        responses=answers(200, RowShape, ACTS),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(ReturnRequestSerializer(data=request.data))
        with refusals():
            row = return_requests.plan(campaign, wanted["submission"], wanted["reason"], caller(request))
        return Response(RowShape(row).data)


class Send(ManagersView):
    @extend_schema(
        operation_id="send_outbox",
        summary="Send what is planned, and ask about what got no answer",
        request=None,
        responses=answers(202, JobShape, ACTS),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        with refusals():
            accounts.key(accounts.of(campaign))
        return started(sending.start(campaign, caller(request)))


class OneRow(ManagersView):
    @extend_schema(
        operation_id="decide_outbox_row",
        summary="Decide about one row",
        request=OutboxDecisionSerializer,
        responses=answers(200, RowShape, ACTS),
    )
    def post(self, request: Request, slug: str, name: str, pk: int) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(OutboxDecisionSerializer(data=request.data))
        with refusals():
            rows.decide(row_or_404(campaign, pk), wanted["action"], caller(request))
        return Response(RowShape(row_or_404(campaign, pk)).data)


FILE = OpenApiParameter("what", str, OpenApiParameter.PATH, enum=list(handover.KINDS))


class HandoverFile(Download, ManagersView):
    @extend_schema(
        operation_id="handover_file",
        summary="What is planned, as a file for the platform",
        description="The header `X-Upto` is the last row in it, for marking it as done.",
        parameters=[FILE],
        responses={(200, "text/csv"): OpenApiTypes.STR, **READS_REFUSED},
    )
    def get(self, request: Request, slug: str, name: str, what: str) -> HttpResponse:
        campaign = campaign_or_404(slug, name)
        try:
            made = handover.made(campaign, what)
        except handover.HandoverError:
            raise Http404 from None
        headers = {"X-Upto": str(made.upto)}
        return HttpResponse(made.text, content_type="text/csv; charset=utf-8", headers=headers)


class HandoverDone(ManagersView):
    @extend_schema(
        operation_id="handover_done",
        summary="Say that a file was carried out at the platform",
        parameters=[FILE],
        request=HandedOverSerializer,
        responses=answers(200, DoneShape, ACTS),
    )
    def post(self, request: Request, slug: str, name: str, what: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(HandedOverSerializer(data=request.data))
        try:
            return Response({"done": handover.done(campaign, what, wanted["upto"], caller(request))})
        except handover.HandoverError:
            raise Http404 from None


class Submissions(ManagersView):
    @extend_schema(
        operation_id="take_in_submissions",
        summary="Take in Prolific's list of submissions",
        request=SubmissionsSerializer,
        responses=answers(200, SubmissionsShape, ACTS),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(SubmissionsSerializer(data=request.data))
        with refusals():
            lines, news = handover.take_in(campaign, wanted["csv"].encode("utf-8", "replace"))
        return Response({"lines": lines, "news": news})


def row_or_404(campaign: Campaign, pk: int) -> OutboxRow:
    found = overview.listed(campaign).filter(pk=pk).first() if pk <= LARGEST_ROW else None
    if found is None:
        raise Http404
    return found
