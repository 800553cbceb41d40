"""Keys for scripts: made, shown once, looked up by their digest, revoked."""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Collection
from datetime import datetime, timedelta

from django.contrib.auth.models import User
from django.db.models import Q, QuerySet
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import ApiToken
from gtm_hit.ops.access.roles import SEES, Role, may, may_everywhere
from gtm_hit.ops.errors import OperationError

PREFIX = "gtm_"  # so that scanners for leaked keys can tell what they found
LAST_USE_EVERY = timedelta(minutes=1)


class TokenError(OperationError, ValueError):
    """A token that cannot be made; says why."""


class BadKey(OperationError):
    """No token's key, or one that is revoked or expired, or whose owner may nothing any more."""


def make(
    user: User, name: str, scopes: Collection[str], expires_at: datetime | None = None
) -> tuple[ApiToken, str]:
    """The token and its key, which nobody can read again. Raises TokenError."""
    name = name.strip()
    if not name or len(name) > 100:
        raise TokenError(_("A token needs a name of at most 100 characters."))
    unknown = sorted(set(scopes) - set(ApiToken.Scope.values))
    if unknown or not scopes:
        known = ", ".join(ApiToken.Scope.values)
        raise TokenError(_("A token needs at least one of these scopes: %(known)s.") % {"known": known})
    if not may(user, SEES):
        raise TokenError(_("Only who has a role for a dataset may have tokens, and annotators need none."))
    if expires_at and expires_at <= timezone.now():
        raise TokenError(_("A token must not have expired before it is made."))
    key = PREFIX + secrets.token_urlsafe(32)
    ordered = [scope for scope in ApiToken.Scope.values if scope in scopes]
    token = ApiToken.objects.create(
        user=user, name=name, digest=digest(key), scopes=ordered, expires_at=expires_at
    )
    return token, key


def find(key: str) -> ApiToken:
    """The valid token of this key. Raises BadKey."""
    token = valid().select_related("user").filter(digest=digest(key)).first()
    if token is None or not may(token.user, SEES):
        raise BadKey("unknown, revoked or expired")
    now = timezone.now()
    if token.last_used_at is None or token.last_used_at < now - LAST_USE_EVERY:
        ApiToken.objects.filter(pk=token.pk).update(last_used_at=now)
    return token


def valid() -> QuerySet[ApiToken]:
    current = Q(expires_at__isnull=True) | Q(expires_at__gt=timezone.now())
    return ApiToken.objects.filter(current, revoked_at__isnull=True, user__is_active=True)


def visible_to(user: User) -> QuerySet[ApiToken]:
    """One's own tokens; administrators see and revoke everybody's."""
    found = ApiToken.objects.select_related("user")
    return found if may_everywhere(user, Role.ADMINISTRATOR) else found.filter(user=user)


def revoke(token: ApiToken) -> None:
    ApiToken.objects.filter(pk=token.pk, revoked_at__isnull=True).update(revoked_at=timezone.now())


def digest(key: str) -> str:
    # 256 random bits: there is nothing to guess, so no slow hash is needed.
    return hashlib.sha256(key.encode(errors="surrogateescape")).hexdigest()
