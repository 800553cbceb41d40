"""Who is asking: the holder of a signed token, or somebody with a role and a session."""

from __future__ import annotations

from copy import copy
from typing import Any, ClassVar

from django.contrib.auth.models import AnonymousUser
from django.http import Http404, QueryDict
from django.utils.datastructures import MultiValueDict
from django.utils.translation import gettext as _
from rest_framework.authentication import BaseAuthentication, SessionAuthentication
from rest_framework.exceptions import AuthenticationFailed, PermissionDenied
from rest_framework.permissions import SAFE_METHODS, BasePermission
from rest_framework.request import Request
from rest_framework.views import APIView

from gtm_hit.models import ApiToken, Assignment, Dataset, Layer
from gtm_hit.ops import api_tokens
from gtm_hit.ops.access.desks import desk_verdict
from gtm_hit.ops.access.roles import (
    SEES,
    Role,
    Roles,
    Verdict,
    has_role,
    may,
    may_everywhere,
    verdict,
)
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

    Nobody's body is read before he is known to have a role and to come from our pages: it may be an archive.
    """

    def authenticate(self, request: Request) -> tuple[Any, Any] | None:
        user = request._request.user
        if user.is_authenticated and not has_role(user):
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


class StaffMay(BasePermission):
    """Whoever has the role; at the browser that is all, scripts may only what their tokens are for.

    Reading takes the view's `read_role` and `read_scope`, anything else `write_role` and `write_scope`:
    for the dataset in the address, or for any where there is none.
    """

    def has_permission(self, request: Request, view: APIView) -> bool:
        if not request.user.is_authenticated:
            return False
        reads = request.method in SAFE_METHODS
        usual = SEES if reads else Role.ADMINISTRATOR
        if not _may(request.user, getattr(view, "read_role" if reads else "write_role", usual), view):
            return False
        if isinstance(request.auth, ApiToken):
            _refuse_out_of_scope(request.auth, view, reads)
        return True


def _may(user: Any, roles: Roles, view: APIView) -> bool:
    if "desk" in view.kwargs:
        found = desk_verdict(user, roles, view.kwargs["desk"])
        if found is Verdict.HIDDEN:
            raise Http404
        return found is Verdict.MAY
    if "slug" in view.kwargs:
        dataset = Dataset.objects.filter(slug=view.kwargs["slug"]).first()
    elif "layer" in view.kwargs:
        layer = Layer.objects.select_related("dataset").filter(pk=view.kwargs["layer"]).first()
        dataset = layer.dataset if layer else None
    elif getattr(view, "everywhere", False):
        return may_everywhere(user, roles)
    else:
        return may(user, roles)
    found = verdict(user, roles, dataset)
    if found is Verdict.HIDDEN:
        raise Http404
    return found is Verdict.MAY


def _refuse_out_of_scope(token: ApiToken, view: APIView, reads: bool) -> None:
    usual = ApiToken.Scope.READ if reads else None
    needed = getattr(view, "read_scope" if reads else "write_scope", usual)
    if needed is None:
        raise PermissionDenied(_("This is not done with a token, but at the browser."))
    if needed not in token.scopes:
        raise PermissionDenied(_("The token lacks the scope %(scope)s.") % {"scope": needed})
