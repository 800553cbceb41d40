"""The description of the REST interface as a page."""

from __future__ import annotations

from typing import Any

from drf_spectacular.views import SpectacularSwaggerSplitView
from rest_framework.negotiation import BaseContentNegotiation
from rest_framework.renderers import JSONRenderer
from rest_framework.request import Request
from rest_framework.response import Response


class PageOrJson(BaseContentNegotiation):
    """The page for whoever reads it; what has no page is answered as everywhere else."""

    def select_renderer(self, request: Any, renderers: Any, format_suffix: Any = None) -> Any:
        chosen = renderers[0] if request.method in {"GET", "HEAD"} else JSONRenderer()
        return chosen, chosen.media_type


class DocsView(SpectacularSwaggerSplitView):
    """With its script as a file of its own: pages run none that stands in them."""

    content_negotiation_class = PageOrJson

    def finalize_response(self, request: Request, response: Any, *args: Any, **kwargs: Any) -> Response:
        if getattr(response, "exception", False):
            request.accepted_renderer = JSONRenderer()
            request.accepted_media_type = "application/json"
        return super().finalize_response(request, response, *args, **kwargs)
