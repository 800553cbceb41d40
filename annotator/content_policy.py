"""What a page may load and run: only what comes from this server."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from django.conf import settings
from django.http import HttpRequest
from django.http.response import HttpResponseBase

HEADER = "Content-Security-Policy"


def policy(ancestors: Sequence[str] = ("'none'",), forms: Sequence[str] = ()) -> str:
    """`ancestors` may show the page in a frame; `forms` get what is sent off from it, beside us."""
    return "; ".join(
        [
            "default-src 'self'",
            # Pictures the pages make themselves.
            "img-src 'self' blob: data:",
            "object-src 'none'",
            "base-uri 'none'",
            " ".join(["form-action 'self'", *forms]),
            " ".join(["frame-ancestors", *ancestors]),
        ]
    )


POLICY = policy()
# A drawing brings its style along.
FIGURE = "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'"


class ContentPolicyMiddleware:
    """Answers that bring a policy of their own keep it."""

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponseBase]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponseBase:
        response = self.get_response(request)
        # Django's page of a traceback has its script and style in itself.
        if HEADER not in response and not (settings.DEBUG and response.status_code in {404, 500}):
            drawing = response.get("Content-Type", "").startswith("image/svg")
            response[HEADER] = FIGURE if drawing else POLICY
        return response
