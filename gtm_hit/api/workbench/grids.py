"""Grid files, addressed by their content, for those who annotate the dataset."""

from __future__ import annotations

from typing import Any

from django.conf import settings
from django.db.models import QuerySet
from django.http import FileResponse, Http404, HttpResponseNotModified
from django.http.response import HttpResponseBase
from django.utils.cache import get_conditional_response
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework.request import Request

from gtm_hit.api.common.refusals import REFUSALS
from gtm_hit.api.workbench.images import ContentView
from gtm_hit.models import Assignment, Camera
from gtm_hit.ops.access.roles import datasets_of
from gtm_hit.ops.ground import grid_files
from gtm_hit.ops.work import links


class GridView(ContentView):
    @extend_schema(
        summary="Rectangles of the usual person at every position, in one camera",
        description="A gzip file; its format is told in gtm_hit/geometry/grid_file.py.",
        parameters=[OpenApiParameter("digest", str, OpenApiParameter.PATH, description="SHA-256, 64 digits")],
        responses={(200, "application/gzip"): OpenApiTypes.BINARY, **REFUSALS},
    )
    def get(self, request: Request, digest: str) -> HttpResponseBase:
        row = self._camera(request, digest)
        etag = f'"{digest}"'
        known = get_conditional_response(request._request, etag=etag)
        if isinstance(known, HttpResponseNotModified):
            return self.kept_for_ever(known, etag)
        file = grid_files.find(row).open("rb")
        return self.kept_for_ever(FileResponse(file, content_type="application/gzip"), etag)

    def _camera(self, request: Request, digest: str) -> Camera:
        """One whose calibration gives the file, among those that the caller may see."""
        for row in self._cameras(request):
            if grid_files.digest_of(row.dataset, row.calibrated) == digest:
                return row
        raise Http404

    def _cameras(self, request: Request) -> QuerySet[Camera]:
        found: dict[str, Any] = {}
        if isinstance(request.auth, Assignment):
            found = {"dataset": request.auth.batch.dataset_id}
        elif isinstance(request.auth, links.Seat):
            found = {"dataset__slug": settings.TUTORIAL_DATASET}
        else:
            found = {"dataset__in": datasets_of(request.user)}
        return Camera.objects.filter(**found).select_related("dataset")
