"""The secret by which a browser is known again, in a signed cookie that no script can read."""

from __future__ import annotations

import secrets

from django.conf import settings
from django.http import HttpRequest, HttpResponse

COOKIE = "browser"
SALT = "gtm_hit.browser"
KEPT_SECONDS = 400 * 24 * 3600  # browsers keep none longer


def secret_of(request: HttpRequest) -> str:
    """The browser's secret; a new one where it has none, which `remember` then gives it."""
    return request.get_signed_cookie(COOKIE, "", salt=SALT) or secrets.token_urlsafe(32)


def remember(response: HttpResponse, secret: str) -> HttpResponse:
    response.set_signed_cookie(
        COOKIE,
        secret,
        salt=SALT,
        max_age=KEPT_SECONDS,
        httponly=True,
        samesite="Lax",
        secure=settings.SESSION_COOKIE_SECURE,
    )
    return response
