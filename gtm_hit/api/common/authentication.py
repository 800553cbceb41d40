"""Who is asking: the holder of a signed token, or staff with a session."""

from __future__ import annotations

from copy import copy
from typing import Any, ClassVar

from django.contrib.auth.models import AnonymousUser
from django.http import QueryDict
from django.utils.datastructures import MultiValueDict
from django.utils.translation import gettext as _
from rest_framework.authentication import BaseAuthentication, SessionAuthentication
from rest_framework.exceptions import AuthenticationFailed, PermissionDenied
from rest_framework.permissions import SAFE_METHODS, BasePermission
from rest_framework.request import Request
from rest_framework.views import APIView

from gtm_hit.models import ApiToken, Assignment, Dataset
from gtm_hit.ops import api_tokens
from gtm_hit.ops.access.roles import may
from gtm_hit.ops.work import links


class TokenAuthentication(BaseAuthentication):
    """`Authorization: <keyword> <token>`; what the token stands for becomes `request.auth`."""

    keyword: ClassVar[str]

    def authenticate(self, request: Request) -> tuple[Any, Any] | None:
        keyword, _space, token = request.META.get("HTTP_AUTHORIZATION", "").partition(" ")
        if keyword.lower() != self.keyword.lower():
            return None
        try:
            return AnonymousUser(), self.read(token.strip())
        except links.BadToken:
            raise AuthenticationFailed(_("The link is not valid any more.")) from None

    def authenticate_header(self, request: Request) -> str:
        return self.keyword

    def read(self, token: str) -> Any:
        raise NotImplementedError


class AssignmentAuthentication(TokenAuthentication):
    keyword = "Assignment"

    def read(self, token: str) -> Assignment:
        return links.read_assignment(token)


class WorkerAuthentication(TokenAuthentication):
    keyword = "Worker"

    def read(self, token: str) -> links.Seat:
        return links.read_worker(token)


class StaffSession(SessionAuthentication):
    """Answers 401 instead of 403 to strangers, so that the browser knows that signing in helps.

    Nobody's body is read before he is known to be staff and to come from our pages: it may be an archive.
    """

    def authenticate(self, request: Request) -> tuple[Any, Any] | None:
        user = request._request.user
        if user.is_active and not user.is_staff:
            raise PermissionDenied()
        return super().authenticate(request)

    def enforce_csrf(self, request: Request) -> None:
        # Django looks for the token in the form first. Ours is in the header.
        headers_only = copy(request._request if isinstance(request, Request) else request)
        headers_only._post, headers_only._files = QueryDict(), MultiValueDict()  # type: ignore[attr-defined]
        super().enforce_csrf(headers_only)  # type: ignore[arg-type]

    def authenticate_header(self, request: Request) -> str:
        return "Session"


class BearerAuthentication(BaseAuthentication):
    """A script that acts under the name of whoever made its key; `request.auth` is the ApiToken."""

    def authenticate(self, request: Request) -> tuple[Any, Any] | None:
        keyword, _space, key = request.META.get("HTTP_AUTHORIZATION", "").partition(" ")
        if keyword.lower() != "bearer":
            return None
        try:
            token = api_tokens.find(key.strip())
        except api_tokens.BadKey:
            raise AuthenticationFailed(_("The token is unknown, revoked or expired.")) from None
        return token.user, token

    def authenticate_header(self, request: Request) -> str:
        return "Bearer"


class HoldsAssignment(BasePermission):
    def has_permission(self, request: Request, view: APIView) -> bool:
        return isinstance(request.auth, Assignment)


class HoldsSeat(BasePermission):
    def has_permission(self, request: Request, view: APIView) -> bool:
        return isinstance(request.auth, links.Seat)


class IsStaff(BasePermission):
    def has_permission(self, request: Request, view: APIView) -> bool:
        return bool(request.user and request.user.is_authenticated and request.user.is_staff)


class StaffMay(IsStaff):
    """Staff at the browser may do everything, their scripts only what their tokens are for.

    Reading takes the view's `read_scope`, anything else its `write_scope`.
    """

    def has_permission(self, request: Request, view: APIView) -> bool:
        if not super().has_permission(request, view):
            return False
        reads = request.method in SAFE_METHODS
        role = getattr(view, "read_role" if reads else "write_role", None)
        if role is not None and not may(request.user, role, _dataset_in_address(view)):
            return False
        if isinstance(request.auth, ApiToken):
            usual = ApiToken.Scope.READ if reads else None
            needed = getattr(view, "read_scope" if reads else "write_scope", usual)
            if needed not in request.auth.scopes:
                raise PermissionDenied(_("The token lacks the scope %(scope)s.") % {"scope": needed})
        return True


def _dataset_in_address(view: APIView) -> Dataset | None:
    slug = view.kwargs.get("slug")
    return Dataset.objects.filter(slug=slug).first() if slug else None
