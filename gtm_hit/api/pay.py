"""What workers of a campaign earned, their bonuses, and what was paid."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import Http404, HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiExample, OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.campaigns import ACTS, campaign_or_404, refusals
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, ManagersView, Pages, answers, caller, invalid
from gtm_hit.api.jobs import Download
from gtm_hit.models import Campaign, MoneyEntry
from gtm_hit.ops.pay import csv_files, ledger, table


def money(**values: Any) -> serializers.DecimalField:
    return serializers.DecimalField(max_digits=11, decimal_places=2, **values)


class WorkerPayShape(serializers.Serializer[Any]):
    worker = serializers.CharField(source="worker.pseudonym", help_text="pseudonym")
    accepted = serializers.IntegerField(help_text="batches")
    waiting = serializers.IntegerField(help_text="batches handed in and not decided")
    seconds = serializers.FloatField(help_text="active ones, in accepted batches")
    all_seconds = serializers.FloatField(help_text="active ones, in all batches")
    per_hour = money(allow_null=True)
    earned = money(source="balance.earned")
    bonus_approved = money(source="balance.bonus_approved")
    bonus_proposed = money(source="proposed")
    paid = money(source="balance.paid")
    on_its_way = money(source="balance.on_its_way")
    to_pay = money(source="balance.to_pay")
    overpaid = money(source="balance.overpaid")


class TotalsShape(serializers.Serializer[Any]):
    workers = serializers.IntegerField()
    batches = serializers.IntegerField()
    accepted = serializers.IntegerField()
    hours = serializers.DecimalField(max_digits=9, decimal_places=1)
    per_hour = money(allow_null=True)
    cost = money()
    proposed = money()
    paid = money()
    on_its_way = money()
    to_pay = money()
    forecast = money(help_text="of all batches, if the rest costs what the accepted ones did")


class PayShape(serializers.Serializer[Any]):
    currency = serializers.CharField()
    totals = TotalsShape()
    workers = WorkerPayShape(many=True)


class EntryShape(serializers.ModelSerializer[MoneyEntry]):
    worker = serializers.CharField(source="worker.pseudonym")
    by = serializers.CharField(source="user.username", allow_null=True, default=None)
    batch = serializers.IntegerField(source="assignment.batch.number", allow_null=True, default=None)
    takes_back = serializers.IntegerField(source="reverses_id", allow_null=True)

    class Meta:
        model = MoneyEntry
        fields = [
            *("id", "at", "worker", "kind", "amount", "currency", "batch", "by", "note", "takes_back"),
        ]


class BonusesSerializer(serializers.Serializer[Any]):
    workers = serializers.ListField(
        child=serializers.CharField(max_length=20),
        max_length=1000,
        allow_null=True,
        default=None,
        help_text="pseudonyms; null: everybody a bonus is proposed for",
    )
    amount = money(allow_null=True, default=None, help_text="for one worker, instead of what is proposed")


class PaymentSerializer(serializers.Serializer[Any]):
    worker = serializers.CharField(max_length=20, help_text="pseudonym")
    amount = money(allow_null=True, default=None, help_text="null: all there is to pay")
    note = serializers.CharField(max_length=300, default="", allow_blank=True, help_text="how it was paid")


class TakeBackSerializer(serializers.Serializer[Any]):
    note = serializers.CharField(max_length=300, help_text="why")


class Pay(ManagersView):
    @extend_schema(
        operation_id="pay",
        summary="Who earned what, what an hour came to, what is to be paid",
        responses=answers(200, PayShape, READS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        lines = table.workers(campaign)
        shown = {"currency": campaign.currency, "totals": table.totals(campaign, lines), "workers": lines}
        return Response(PayShape(shown).data)


class Bonuses(ManagersView):
    @extend_schema(
        operation_id="approve_bonuses",
        summary="Approve proposed bonuses, or one of another amount",
        request=BonusesSerializer,
        responses=answers(200, EntryShape(many=True), ACTS),
        examples=[OpenApiExample("all that are proposed", {"workers": None}, request_only=True)],
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(BonusesSerializer(data=request.data))
        with refusals():
            added = table.approve_bonuses(campaign, caller(request), wanted["workers"], wanted["amount"])
        return Response(EntryShape(added, many=True).data)


class Payments(ManagersView):
    @extend_schema(
        operation_id="mark_paid",
        summary="Say that a worker was paid by other ways",
        request=PaymentSerializer,
        responses=answers(200, EntryShape, ACTS),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(PaymentSerializer(data=request.data))
        try:
            worker = table.worker_named(campaign, wanted["worker"])
        except ledger.PayError as error:
            raise invalid("worker", error) from error
        with refusals():
            entry = ledger.mark_paid(campaign, worker, caller(request), wanted["amount"], wanted["note"])
        return Response(EntryShape(entry).data)


class Ledger(ManagersView, ListAPIView[MoneyEntry]):
    queryset = MoneyEntry.objects.none()
    serializer_class = EntryShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[MoneyEntry]:
        return table.lines_of(campaign_or_404(self.kwargs["slug"], self.kwargs["name"]))

    @extend_schema(
        operation_id="ledger",
        summary="Every movement of money, newest first",
        responses=answers(200, EntryShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class TakeBack(ManagersView):
    @extend_schema(
        operation_id="take_back",
        summary="Take a bonus or a payment by hand back, by a line of its own",
        request=TakeBackSerializer,
        responses=answers(200, EntryShape, ACTS),
    )
    def post(self, request: Request, slug: str, name: str, pk: int) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(TakeBackSerializer(data=request.data))
        entry = entry_or_404(campaign, pk)
        with refusals():
            back = ledger.take_back(entry, caller(request), wanted["note"])
        return Response(EntryShape(back).data)


class PayTable(Download, ManagersView):
    @extend_schema(
        operation_id="pay_table",
        summary="Pay by worker, or every movement, as CSV",
        parameters=[OpenApiParameter("what", str, OpenApiParameter.PATH, enum=["workers", "ledger"])],
        responses={(200, "text/csv"): OpenApiTypes.STR, **READS},
    )
    def get(self, request: Request, slug: str, name: str, what: str) -> HttpResponse:
        campaign = campaign_or_404(slug, name)
        made = {"workers": csv_files.workers, "ledger": csv_files.ledger_lines}.get(what)
        if made is None:
            raise Http404
        return HttpResponse(made(campaign), content_type="text/csv; charset=utf-8")


def entry_or_404(campaign: Campaign, pk: int) -> MoneyEntry:
    lines = MoneyEntry.objects.select_related("campaign", "worker", "user", "assignment__batch")
    found = lines.filter(campaign=campaign, pk=pk).first() if pk < 2**63 else None
    if found is None:
        raise Http404
    return found
