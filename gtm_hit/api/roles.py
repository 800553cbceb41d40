"""Who has which role. Scripts may read it; giving and taking is done at the browser or by the command."""

from __future__ import annotations

from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, WRITES, StaffView, answers, caller, dataset_or_404, invalid
from gtm_hit.models import Dataset
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role


class HoldingSerializer(serializers.Serializer[Any]):
    user = serializers.CharField(source="user.username", max_length=150, help_text="user name")
    role = serializers.ChoiceField(choices=Role.choices)
    superuser = serializers.BooleanField(
        source="by_account", read_only=True, help_text="comes with the account and cannot be taken here"
    )


class RolesSerializer(serializers.Serializer[Any]):
    results = HoldingSerializer(many=True)


class AskedSerializer(serializers.Serializer[Any]):
    user = serializers.CharField(max_length=150, help_text="user name")
    role = serializers.ChoiceField(choices=Role.choices)


class RolesView(StaffView):
    read_role = Role.ADMINISTRATOR
    write_role = Role.ADMINISTRATOR

    def dataset(self, slug: str | None) -> Dataset | None:
        return dataset_or_404(slug) if slug is not None else None

    def listed(self, slug: str | None) -> Response:
        found = granting.holdings(self.dataset(slug))
        return Response(RolesSerializer({"results": found}).data)

    def change(self, request: Request, slug: str | None, operation: Any) -> Response:
        wanted = valid(AskedSerializer(data=request.data))
        try:
            user = granting.user_named(wanted["user"])
            operation(user, Role(wanted["role"]), self.dataset(slug), caller(request))
        except granting.RoleError as error:
            raise invalid("user", error) from error
        return self.listed(slug)


class DatasetRoles(RolesView):
    @extend_schema(
        operation_id="dataset_roles",
        summary="Who has which role for the dataset",
        responses=answers(200, RolesSerializer, READS),
    )
    def get(self, request: Request, slug: str) -> Response:
        return self.listed(slug)

    @extend_schema(
        operation_id="grant_dataset_role",
        summary="Give somebody a role for the dataset",
        description="With a session only: no token gives roles.",
        request=AskedSerializer,
        responses=answers(200, RolesSerializer, WRITES),
    )
    def post(self, request: Request, slug: str) -> Response:
        return self.change(request, slug, granting.grant)


class TakeDatasetRole(RolesView):
    @extend_schema(
        operation_id="revoke_dataset_role",
        summary="Take somebody's role for the dataset",
        description="With a session only: no token takes roles.",
        request=AskedSerializer,
        responses=answers(200, RolesSerializer, WRITES),
    )
    def post(self, request: Request, slug: str) -> Response:
        return self.change(request, slug, granting.revoke)


class Roles(RolesView):
    everywhere = True

    @extend_schema(
        operation_id="roles",
        summary="Who has which role for all datasets",
        responses=answers(200, RolesSerializer, READS),
    )
    def get(self, request: Request) -> Response:
        return self.listed(None)

    @extend_schema(
        operation_id="grant_role",
        summary="Give somebody a role for all datasets",
        description="With a session only: no token gives roles.",
        request=AskedSerializer,
        responses=answers(200, RolesSerializer, WRITES),
    )
    def post(self, request: Request) -> Response:
        return self.change(request, None, granting.grant)


class TakeRole(RolesView):
    everywhere = True

    @extend_schema(
        operation_id="revoke_role",
        summary="Take somebody's role for all datasets",
        description="With a session only: no token takes roles.",
        request=AskedSerializer,
        responses=answers(200, RolesSerializer, WRITES),
    )
    def post(self, request: Request) -> Response:
        return self.change(request, None, granting.revoke)
