"""Who comes into a campaign: its links, and its workers."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import Http404
from django.urls import reverse
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.campaigns import campaign_or_404
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, WRITES, ManagersView, Pages, answers, caller, invalid
from gtm_hit.crowd.platforms import platform_of
from gtm_hit.models import ApiToken, Campaign, CampaignLink, Worker
from gtm_hit.ops.campaigns import links, overview, seats, standing
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work import links as work_links
from gtm_hit.ops.work.workers import MAX_ID


class LinkShape(serializers.ModelSerializer[CampaignLink]):
    link = serializers.SerializerMethodField(help_text="empty when it opens nothing any more")
    worker = serializers.CharField(source="worker.pseudonym", default=None, allow_null=True)

    class Meta:
        model = CampaignLink
        fields = ["id", "kind", "state", "link", "worker", "note", "uses", "created_at", "expires_at"]

    def get_link(self, link: CampaignLink) -> str:
        return address(self.context["request"], link) if link.state == "open" else ""


def address(request: Request, link: CampaignLink) -> str:
    """What is pasted into the platform, or sent to somebody."""
    view = "invitation" if link.kind == CampaignLink.Kind.INVITATION else "join"
    plain = request.build_absolute_uri(reverse(view, args=[links.token(link)]))
    general = link.kind == CampaignLink.Kind.GENERAL
    return platform_of(link.campaign).entry_address(plain) if general else plain


class MakeLinkSerializer(serializers.Serializer[Any]):
    kind = serializers.ChoiceField(choices=CampaignLink.Kind.choices, default=CampaignLink.Kind.GENERAL)
    worker = serializers.CharField(max_length=MAX_ID, required=False, help_text="for a personal link")
    note = serializers.CharField(max_length=links.MAX_NOTE, default="", allow_blank=True)
    days = serializers.IntegerField(min_value=1, max_value=links.MAX_DAYS, required=False)


class LinkDeedSerializer(serializers.Serializer[Any]):
    deed = serializers.ChoiceField(choices=["revoke", "rotate"])


class CampaignLinks(ManagersView):
    # A link lets workers in, and that is more than reading.
    read_scope = ApiToken.Scope.WORK

    @extend_schema(
        operation_id="campaign_links",
        summary="A campaign's links, the newest first",
        responses=answers(200, LinkShape(many=True), READS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        found = campaign_or_404(slug, name).links.select_related("worker", "campaign__dataset")
        pages = Pages()
        page = pages.paginate_queryset(found, request, view=self)
        return pages.get_paginated_response(LinkShape(page, many=True, context={"request": request}).data)

    @extend_schema(
        operation_id="make_campaign_link",
        summary="Make a link: general, one worker's own, or an invitation to an account",
        request=MakeLinkSerializer,
        responses=answers(201, LinkShape, WRITES),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(MakeLinkSerializer(data=request.data))
        try:
            whose = wanted.pop("worker", None)
            worker = standing.known_or_new(campaign, whose) if whose else None
            made = links.make(campaign, **wanted, worker=worker, user=caller(request))
        except CampaignError as error:
            raise invalid(error.field, error) from error
        return Response(LinkShape(made, context={"request": request}).data, status=201)


class OneCampaignLink(ManagersView):
    @extend_schema(
        operation_id="change_campaign_link",
        summary="Revoke a link, or give it another address",
        request=LinkDeedSerializer,
        responses=answers(200, LinkShape, WRITES),
    )
    def post(self, request: Request, slug: str, name: str, pk: int) -> Response:
        rows = campaign_or_404(slug, name).links.select_related("campaign__dataset", "worker")
        link = rows.filter(pk=pk).first()
        if link is None:
            raise Http404
        wanted = valid(LinkDeedSerializer(data=request.data))
        try:
            (links.revoke if wanted["deed"] == "revoke" else links.rotate)(link)
        except CampaignError as error:
            raise invalid("deed", error) from error
        return Response(LinkShape(rows.get(pk=pk), context={"request": request}).data)


class IntervalShape(serializers.Serializer[Any]):
    score = serializers.IntegerField()
    low = serializers.IntegerField(help_text="the true one lies between low and high nine times out of ten")
    high = serializers.IntegerField()


class WorkerShape(serializers.Serializer[Any]):
    worker = serializers.CharField(source="worker.pseudonym", help_text="pseudonym")
    standing = serializers.CharField(help_text="invited, blocked, or empty")
    batches = serializers.IntegerField()
    submitted = serializers.IntegerField()
    states = serializers.DictField(source="counts", child=serializers.IntegerField())
    frames_done = serializers.IntegerField()
    active_minutes = serializers.FloatField(source="minutes")
    last_batch_at = serializers.DateTimeField(source="last_at", allow_null=True)
    score = IntervalShape(allow_null=True, help_text="0 to 100; null: nothing measured yet")


class StandingSerializer(serializers.Serializer[Any]):
    deed = serializers.ChoiceField(choices=["invite", "block", "forget", "revoke_links", "revoke_link"])
    reason = serializers.CharField(max_length=standing.MAX_REASON, default="", allow_blank=True)
    assignment = serializers.IntegerField(min_value=1, required=False, help_text="for revoke_link")


class CampaignWorkers(ManagersView):
    @extend_schema(
        operation_id="campaign_workers",
        summary="A campaign's workers by pseudonym, the latest at work first",
        responses=answers(200, WorkerShape(many=True), READS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        pages = Pages()
        found: QuerySet[Worker] = overview.workers(campaign)
        rows = overview.worker_rows(campaign, pages.paginate_queryset(found, request, view=self) or [])
        return pages.get_paginated_response(WorkerShape(rows, many=True).data)


class OneCampaignWorker(ManagersView):
    @extend_schema(
        operation_id="decide_campaign_worker",
        summary="Invite or block a worker, or end the links that lead to their work",
        description="`worker` is a pseudonym, or the platform's id; inviting takes ids nobody knew yet.",
        request=StandingSerializer,
        responses=answers(204, None, WRITES),
    )
    def post(self, request: Request, slug: str, name: str, worker: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(StandingSerializer(data=request.data))
        try:
            self.decide(campaign, worker, wanted, request)
        except CampaignError as error:
            raise invalid(error.field, error) from error
        return Response(status=204)

    def decide(self, campaign: Campaign, name: str, wanted: dict[str, Any], request: Request) -> None:
        if wanted["deed"] == "invite":
            standing.invite(campaign, name, caller(request))
            return
        worker = None if "\x00" in name else seats.named(campaign, name)
        if worker is None:
            raise Http404
        match wanted["deed"]:
            case "block":
                standing.block(campaign, worker, wanted["reason"], caller(request))
            case "forget":
                standing.forget(campaign, worker)
            case "revoke_links":
                seats.revoke(worker, caller(request))
            case "revoke_link":
                rows = worker.assignments.filter(batch__campaign=campaign, pk=wanted.get("assignment", 0))
                if (found := rows.first()) is None:
                    raise invalid("assignment", "The worker has no such assignment in this campaign.")
                work_links.revoke_assignment(found)
