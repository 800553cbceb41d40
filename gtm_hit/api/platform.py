"""A campaign's study at its platform, and how it is reached."""

from __future__ import annotations

from typing import Any

from django.urls import reverse
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.campaigns import ACTS, ASKS_PLATFORM, campaign_or_404, refusals
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, ManagersView, answers, caller
from gtm_hit.crowd.prolific import connect
from gtm_hit.models import PlatformAccount
from gtm_hit.ops.outbox import accounts, studies
from gtm_hit.ops.outbox.platform import StudyDraft


class AccountShape(serializers.Serializer[Any]):
    address = serializers.CharField(help_text="empty: the first one this server knows")
    study = serializers.CharField()
    study_state = serializers.CharField(help_text="in the platform's words, as last heard")
    completion_code = serializers.CharField()
    has_key = serializers.BooleanField(help_text="keys themselves are never told")
    has_secret = serializers.BooleanField()


class AccountSerializer(serializers.Serializer[Any]):
    address = serializers.CharField(max_length=200, default="", allow_blank=True)
    study = serializers.CharField(max_length=64, default="", allow_blank=True)
    token = serializers.CharField(
        max_length=200, default="", allow_blank=True, help_text="empty: as it is; a dash: none any more"
    )
    hook_secret = serializers.CharField(
        max_length=200, default="", allow_blank=True, help_text="empty: as it is; a dash: none any more"
    )


class StudySerializer(serializers.Serializer[Any]):
    title = serializers.CharField(max_length=200)
    description = serializers.CharField(max_length=5000)
    address = serializers.CharField(max_length=1000, help_text="where workers are sent, with placeholders")
    places = serializers.IntegerField(min_value=1, max_value=100_000)
    minutes = serializers.IntegerField(min_value=1, max_value=1440)
    reward = serializers.DecimalField(max_digits=7, decimal_places=2, min_value=0)
    completion_code = serializers.RegexField(r"^[A-Za-z0-9_-]{4,40}\Z", max_length=40)


class ChangeSerializer(serializers.Serializer[Any]):
    action = serializers.ChoiceField(choices=[*studies.ACTIONS, "look"])


class Account(ManagersView):
    @extend_schema(
        operation_id="platform_account",
        summary="How a campaign's platform is reached, without any key",
        responses=answers(200, AccountShape, READS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        return shown(accounts.of(campaign_or_404(slug, name)))

    @extend_schema(
        operation_id="change_platform_account",
        summary="Change how a campaign's platform is reached",
        request=AccountSerializer,
        responses=answers(200, AccountShape, ACTS),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(AccountSerializer(data=request.data))
        with refusals():
            return shown(accounts.configure(campaign, caller(request), **wanted))


class MessagesSerializer(serializers.Serializer[Any]):
    workspace = serializers.CharField(max_length=64)


class Messages(ManagersView):
    @extend_schema(
        operation_id="have_messages_sent",
        summary="Have the platform send its messages to this server",
        request=MessagesSerializer,
        responses=answers(200, AccountShape, ASKS_PLATFORM),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        workspace = valid(MessagesSerializer(data=request.data))["workspace"]
        target = request.build_absolute_uri(reverse("hook-prolific", args=[slug, name]))
        with refusals():
            platform, by = connect(campaign), caller(request)
            return shown(studies.have_messages_sent(campaign, platform, workspace, target, by))


class DraftStudy(ManagersView):
    @extend_schema(
        operation_id="draft_study",
        summary="Draft a study; nobody sees it and it costs nothing",
        request=StudySerializer,
        responses=answers(200, AccountShape, ASKS_PLATFORM),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = StudyDraft(**valid(StudySerializer(data=request.data)))
        with refusals():
            return shown(studies.draft(campaign, connect(campaign), wanted, caller(request)))


class ChangeStudy(ManagersView):
    @extend_schema(
        operation_id="change_study",
        summary="Publish, pause, resume or stop the study, or look how it stands",
        request=ChangeSerializer,
        responses=answers(200, AccountShape, ASKS_PLATFORM),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        action = valid(ChangeSerializer(data=request.data))["action"]
        with refusals():
            if action == "look":
                return shown(studies.look(campaign, connect(campaign))[0])
            return shown(studies.change(campaign, connect(campaign), action, caller(request)))


def shown(account: PlatformAccount) -> Response:
    names = ("address", "study", "study_state", "completion_code")
    values: dict[str, Any] = {name: getattr(account, name) for name in names}
    values |= {"has_key": accounts.has_key(account), "has_secret": bool(account.hook_secret)}
    return Response(AccountShape(values).data)
