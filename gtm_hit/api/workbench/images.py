"""Pictures, addressed by their content, for those who may see them."""

from __future__ import annotations

from typing import Any

from django.core.files.storage import default_storage
from django.db.models import Q
from django.http import FileResponse, Http404, HttpResponse, HttpResponseNotModified
from django.http.response import HttpResponseBase
from django.utils.cache import get_conditional_response
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework.permissions import BasePermission
from rest_framework.request import Request
from rest_framework.views import APIView

from gtm_hit.api.common.authentication import (
    AssignmentAuthentication,
    BearerAuthentication,
    HoldsAssignment,
    HoldsSeat,
    StaffMay,
    StaffSession,
    WorkerAuthentication,
)
from gtm_hit.api.common.refusals import REFUSALS
from gtm_hit.models import Assignment, Image
from gtm_hit.ops.access.roles import datasets_of
from gtm_hit.ops.tutorial import lesson
from gtm_hit.ops.work import links


class MaySeePictures(BasePermission):
    def has_permission(self, request: Request, view: APIView) -> bool:
        return any(rule().has_permission(request, view) for rule in (HoldsAssignment, HoldsSeat, StaffMay))


class ContentView(APIView):
    """Files that are no JSON, under names that never get other bytes."""

    authentication_classes = [
        AssignmentAuthentication,
        WorkerAuthentication,
        BearerAuthentication,
        StaffSession,
    ]
    permission_classes = [MaySeePictures]

    def perform_content_negotiation(self, request: Request, force: bool = False) -> Any:
        # A client that accepts pictures only is right here.
        return super().perform_content_negotiation(request, force=True)

    def kept_for_ever(self, response: HttpResponseBase, etag: str) -> HttpResponseBase:
        response["ETag"] = etag
        response["Cache-Control"] = "private, max-age=31536000, immutable"
        response["X-Content-Type-Options"] = "nosniff"
        return response


class ImageView(ContentView):
    @extend_schema(
        summary="A picture",
        parameters=[OpenApiParameter("digest", str, OpenApiParameter.PATH, description="SHA-256, 64 digits")],
        responses={(200, "image/jpeg"): OpenApiTypes.BINARY, **REFUSALS},
    )
    def get(self, request: Request, digest: str) -> HttpResponseBase:
        images = Image.objects.filter(Q(light_digest=digest) | Q(full_digest=digest))
        if isinstance(request.auth, Assignment):
            images = images.filter(frame__batches=request.auth.batch_id)
        elif isinstance(request.auth, links.Seat):
            images = images.filter(frame__in=lesson.shown_frames())
        else:
            images = images.filter(frame__dataset__in=datasets_of(request.user))
        if not images.exists():
            raise Http404
        etag = f'"{digest}"'
        # A name never gets other bytes, so a browser that has it needs no file opened here.
        response = get_conditional_response(request._request, etag=etag) or self.file(digest)
        if isinstance(response, FileResponse | HttpResponseNotModified):
            return self.kept_for_ever(response, etag)
        return response

    def file(self, digest: str) -> HttpResponse | FileResponse:
        try:
            picture = default_storage.open(f"images/{digest[:2]}/{digest}.jpg")
        except FileNotFoundError:
            raise Http404 from None
        return FileResponse(picture, content_type="image/jpeg")
