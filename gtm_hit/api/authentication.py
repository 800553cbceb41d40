"""Who is asking: the holder of a signed token, or staff with a session."""

from __future__ import annotations

from typing import Any, ClassVar

from django.contrib.auth.models import AnonymousUser
from django.utils.translation import gettext as _
from rest_framework.authentication import BaseAuthentication, SessionAuthentication
from rest_framework.exceptions import AuthenticationFailed
from rest_framework.permissions import BasePermission
from rest_framework.request import Request
from rest_framework.views import APIView

from gtm_hit.models import Assignment
from gtm_hit.ops import tokens


class TokenAuthentication(BaseAuthentication):
    """`Authorization: <keyword> <token>`; what the token stands for becomes `request.auth`."""

    keyword: ClassVar[str]

    def authenticate(self, request: Request) -> tuple[Any, Any] | None:
        keyword, _space, token = request.META.get("HTTP_AUTHORIZATION", "").partition(" ")
        if keyword.lower() != self.keyword.lower():
            return None
        try:
            return AnonymousUser(), self.read(token.strip())
        except tokens.BadToken:
            raise AuthenticationFailed(_("The link is not valid any more.")) from None

    def authenticate_header(self, request: Request) -> str:
        return self.keyword

    def read(self, token: str) -> Any:
        raise NotImplementedError


class AssignmentAuthentication(TokenAuthentication):
    keyword = "Assignment"

    def read(self, token: str) -> Assignment:
        return tokens.read_assignment(token)


class WorkerAuthentication(TokenAuthentication):
    keyword = "Worker"

    def read(self, token: str) -> tokens.Seat:
        return tokens.read_worker(token)


class StaffSession(SessionAuthentication):
    """Answers 401 instead of 403 to strangers, so that the browser knows that signing in helps."""

    def authenticate_header(self, request: Request) -> str:
        return "Session"


class HoldsAssignment(BasePermission):
    def has_permission(self, request: Request, view: APIView) -> bool:
        return isinstance(request.auth, Assignment)


class HoldsSeat(BasePermission):
    def has_permission(self, request: Request, view: APIView) -> bool:
        return isinstance(request.auth, tokens.Seat)


class IsStaff(BasePermission):
    def has_permission(self, request: Request, view: APIView) -> bool:
        return bool(request.user and request.user.is_authenticated and request.user.is_staff)
