"""Campaigns of a dataset: rules, states, how they go."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from drf_spectacular.utils import OpenApiExample, extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.campaigns import campaign_or_404
from gtm_hit.api.common.refusals import refusal, valid
from gtm_hit.api.common.staff import (
    READS,
    WRITES,
    Conflict,
    ManagersView,
    answers,
    caller,
    dataset_or_404,
    invalid,
)
from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns import changes, editing, overview, states
from gtm_hit.ops.campaigns.course import course
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.campaigns.estimate import estimate


class CampaignSerializer(serializers.ModelSerializer[Campaign]):
    """Rules as they are read and written; what is left out stays, or is the usual."""

    platform_settings = serializers.DictField(required=False)

    class Meta:
        model = Campaign
        fields = [*changes.FIELDS, "state", "created_at", "opened_at", "closed_at"]
        read_only_fields = ["state", "created_at", "opened_at", "closed_at"]
        # The operation says better what is wrong with two of them together.
        validators: list[Any] = []


class CourseSerializer(serializers.Serializer[Any]):
    state = serializers.CharField()
    frames = serializers.IntegerField(help_text="of all batches, every copy counted")
    frames_submitted = serializers.IntegerField()
    batches = serializers.DictField(child=serializers.IntegerField(), help_text="by state; free: for anybody")
    done_at = serializers.DateTimeField(allow_null=True, help_text="forecast at the pace of the last days")
    cost_so_far = serializers.DecimalField(
        12, 2, help_text="submitted and not rejected, with approved bonuses"
    )
    cost_in_all = serializers.DecimalField(12, 2)
    currency = serializers.CharField()


class StepSerializer(serializers.Serializer[Any]):
    step = serializers.ChoiceField(choices=list(states.STEPS))


class Campaigns(ManagersView):
    @extend_schema(
        operation_id="campaigns",
        summary="Campaigns of a dataset, the newest first",
        responses=answers(200, CampaignSerializer(many=True), READS),
    )
    def get(self, request: Request, slug: str) -> Response:
        found = overview.campaigns(dataset_or_404(slug))
        return Response(CampaignSerializer(found, many=True).data)

    @extend_schema(
        operation_id="make_campaign",
        summary="Make a campaign; it is a draft until it is opened",
        request=CampaignSerializer,
        responses=answers(201, CampaignSerializer, WRITES),
        examples=[
            OpenApiExample(
                "two copies on Prolific",
                {
                    "name": "walk",
                    "platform": "prolific",
                    "copies": 2,
                    "pay_per_batch": "3.00",
                    "currency": "GBP",
                    "platform_settings": {"code_completed": "C1A2B3"},
                },
                request_only=True,
            )
        ],
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        try:
            made = editing.create(dataset, read(request.data, CampaignSerializer), caller(request))
        except CampaignError as error:
            raise invalid(error.field, error) from error
        return Response(CampaignSerializer(made).data, status=201)


def read(data: Any, shape: type[CampaignSerializer], **options: Any) -> Mapping[str, Any]:
    """What was sent, and nothing that was not; a misspelt rule must not be passed over."""
    wanted = valid(shape(data=data, **options))
    if unknown := sorted(set(data) - set(changes.FIELDS)):
        raise invalid(unknown[0], "A campaign has no such field, or it is not changed like this.")
    return wanted


class OneCampaign(ManagersView):
    @extend_schema(
        operation_id="campaign",
        summary="One campaign's rules",
        responses=answers(200, CampaignSerializer, READS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        return Response(CampaignSerializer(campaign_or_404(slug, name)).data)

    @extend_schema(
        operation_id="edit_campaign",
        summary="Change rules of a campaign",
        description="What an open campaign may still change: docs/campaigns.md. All of it, or nothing.",
        request=CampaignSerializer(partial=True),
        responses=answers(200, CampaignSerializer, WRITES),
    )
    def patch(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        try:
            changed = editing.edit(campaign, read(request.data, CampaignSerializer, partial=True))
        except CampaignError as error:
            raise invalid(error.field, error) from error
        return Response(CampaignSerializer(changed).data)


class CampaignStep(ManagersView):
    @extend_schema(
        operation_id="campaign_step",
        summary="Open, pause or close a campaign",
        description="Opening cuts the batches. The same step again changes nothing.",
        request=StepSerializer,
        responses=answers(200, CampaignSerializer, {**WRITES, 409: refusal("under_way")}),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(StepSerializer(data=request.data))
        try:
            return Response(CampaignSerializer(states.take(campaign, wanted["step"])).data)
        except CampaignError as error:
            raise Conflict(str(error)) from error


class CampaignCourse(ManagersView):
    @extend_schema(
        operation_id="campaign_course",
        summary="How a campaign goes: batches by state, forecast, cost",
        responses=answers(200, CourseSerializer, READS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        going = course(campaign)
        shown = {
            "state": campaign.state,
            "frames": going.frames,
            "frames_submitted": going.frames_done,
            "batches": dict(going.batches),
            "done_at": going.done_at,
            "cost_so_far": overview.money(campaign).so_far,
            "cost_in_all": estimate(campaign).cost,
            "currency": campaign.currency,
        }
        return Response(CourseSerializer(shown).data)
