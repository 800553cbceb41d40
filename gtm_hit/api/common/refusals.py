"""What is asked of a request, and how a refusal looks."""

from __future__ import annotations

from typing import Any

from drf_spectacular.utils import OpenApiResponse
from rest_framework import serializers


class ErrorSerializer(serializers.Serializer[Any]):
    code = serializers.CharField()
    message = serializers.CharField()
    details = serializers.JSONField(allow_null=True)


def valid(serializer: serializers.Serializer[Any]) -> dict[str, Any]:
    serializer.is_valid(raise_exception=True)
    return serializer.validated_data


def refusal(text: str) -> OpenApiResponse:
    return OpenApiResponse(ErrorSerializer, text)


REFUSALS = {401: refusal("not_signed_in"), 404: refusal("not_found")}
