"""How the signed tokens appear in the OpenAPI description."""

from __future__ import annotations

from typing import Any

from drf_spectacular.extensions import OpenApiAuthenticationExtension


class AssignmentScheme(OpenApiAuthenticationExtension):
    target_class = "gtm_hit.api.common.authentication.AssignmentAuthentication"
    name = "assignment"

    def get_security_definition(self, auto_schema: Any) -> dict[str, str]:
        return header("`Assignment <token>`, from the worker's link")


class WorkerScheme(OpenApiAuthenticationExtension):
    target_class = "gtm_hit.api.common.authentication.WorkerAuthentication"
    name = "worker"

    def get_security_definition(self, auto_schema: Any) -> dict[str, str]:
        return header("`Worker <token>`, from the worker's start page")


class StaffScheme(OpenApiAuthenticationExtension):
    target_class = "gtm_hit.api.common.authentication.StaffSession"
    name = "staff"

    def get_security_definition(self, auto_schema: Any) -> dict[str, str]:
        return {"type": "apiKey", "in": "cookie", "name": "sessionid"}


class BearerScheme(OpenApiAuthenticationExtension):
    target_class = "gtm_hit.api.common.authentication.BearerAuthentication"
    name = "bearer"

    def get_security_definition(self, auto_schema: Any) -> dict[str, str]:
        return {"type": "http", "scheme": "bearer", "description": "a key from `manage.py maketoken`"}


def header(description: str) -> dict[str, str]:
    return {"type": "apiKey", "in": "header", "name": "Authorization", "description": description}
