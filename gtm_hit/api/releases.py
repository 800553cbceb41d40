"""Layers as files: exports, and releases with a number."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import FileResponse, Http404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiExample, OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import (
    READS,
    WRITES,
    Pages,
    StaffView,
    answers,
    caller,
    dataset_or_404,
    invalid,
    layer_named,
    layer_or_404,
)
from gtm_hit.api.jobs import Download, JobShape, started
from gtm_hit.models import ApiToken, Release
from gtm_hit.ops.access.roles import CARES, Role, layers_of
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.exports.formats.registry import DEFAULT_FORMATS, FORMATS
from gtm_hit.ops.releases import releasing


class ReleaseShape(serializers.ModelSerializer[Release]):
    layer = serializers.CharField(source="layer.name")
    calibration = serializers.IntegerField(source="calibration.number", default=None, allow_null=True)
    counts = serializers.DictField(child=serializers.IntegerField())
    created_by = serializers.CharField(source="created_by.username", default=None, allow_null=True)

    class Meta:
        model = Release
        fields = [
            *("number", "title", "layer", "calibration", "counts"),
            *("manifest_digest", "created_by", "created_at"),
        ]


def formats_field(usual: tuple[str, ...]) -> serializers.ListField:
    return serializers.ListField(
        child=serializers.ChoiceField(choices=list(FORMATS)), min_length=1, max_length=20, default=list(usual)
    )


class ExportSerializer(serializers.Serializer[Any]):
    formats = formats_field(DEFAULT_FORMATS)


class MakeReleaseSerializer(serializers.Serializer[Any]):
    layer = serializers.CharField(max_length=120, help_text="name of a layer")
    licence = serializers.CharField(max_length=releasing.MOST_LICENCE, help_text="the whole text")
    title = serializers.CharField(max_length=200, default="", allow_blank=True)
    formats = formats_field(releasing.FORMATS)


class Exports(StaffView):
    write_role = CARES
    write_scope = ApiToken.Scope.RELEASE

    @extend_schema(
        operation_id="start_export",
        summary="Export a layer",
        description="Answers with the job; when it is done, its `download` is the zip's address.",
        request=ExportSerializer,
        responses=answers(202, JobShape, WRITES),
        examples=[OpenApiExample("two formats", {"formats": ["wildtrack", "coco"]}, request_only=True)],
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        layer = layer_or_404(request, slug, name)
        wanted = valid(ExportSerializer(data=request.data))
        return started(exporting.start(layer, caller(request), wanted["formats"]))


class Releases(StaffView, ListAPIView[Release]):
    queryset = Release.objects.none()
    serializer_class = ReleaseShape
    pagination_class = Pages
    write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.RELEASE

    def get_queryset(self) -> QuerySet[Release]:
        return releases_in(self.request, self.kwargs["slug"])

    @extend_schema(
        operation_id="releases",
        summary="Releases of a dataset, the newest first",
        responses=answers(200, ReleaseShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)

    @extend_schema(
        operation_id="make_release",
        summary="Release a layer under the next number",
        description="Answers with the job; its `result.release` is the number when it is done.",
        request=MakeReleaseSerializer,
        responses=answers(202, JobShape, WRITES),
        examples=[
            OpenApiExample(
                "the truth", {"layer": "truth", "licence": "CC BY 4.0", "title": "First"}, request_only=True
            )
        ],
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(MakeReleaseSerializer(data=request.data))
        layer = layer_named(request, dataset, wanted["layer"], "layer")
        order = releasing.Order(
            layer, wanted["licence"], wanted["title"], tuple(wanted["formats"]), caller(request)
        )
        try:
            return started(releasing.start(order))
        except releasing.ReleaseError as error:
            raise invalid("", error) from error


class OneRelease(StaffView):
    @extend_schema(
        operation_id="release",
        summary="A release",
        responses=answers(200, ReleaseShape, READS),
    )
    def get(self, request: Request, slug: str, number: int) -> Response:
        return Response(ReleaseShape(release_or_404(request, slug, number)).data)


class DownloadRelease(Download):
    @extend_schema(
        operation_id="download_release",
        summary="A release's zip",
        responses={(200, "application/zip"): OpenApiTypes.BINARY, **READS},
    )
    def get(self, request: Request, slug: str, number: int) -> FileResponse:
        archive = releasing.archive_of(release_or_404(request, slug, number))
        if not archive.is_file():
            raise Http404
        return FileResponse(archive.open("rb"), as_attachment=True, filename=archive.name)


class ReleaseFile(Download):
    @extend_schema(
        operation_id="release_file",
        summary="One of the files worth having without the zip",
        description="README, licence, changes since the release before, provenance of every annotation, "
        "manifest with the digest of every file.",
        parameters=[OpenApiParameter("name", str, OpenApiParameter.PATH, enum=list(releasing.PARTS))],
        responses={(200, "application/octet-stream"): OpenApiTypes.BINARY, **READS},
    )
    def get(self, request: Request, slug: str, number: int, name: str) -> FileResponse:
        kept = releasing.part_of(release_or_404(request, slug, number), name)
        if kept is None:
            raise Http404
        return FileResponse(
            kept.open("rb"), as_attachment=True, filename=name, content_type="application/octet-stream"
        )


def releases_in(request: Request, slug: str) -> QuerySet[Release]:
    """Without those of layers that the caller may not read."""
    found = releasing.releases(dataset_or_404(slug))
    return found.filter(layer__in=layers_of(caller(request)))


def release_or_404(request: Request, slug: str, number: int) -> Release:
    found = releases_in(request, slug).filter(number=number).first()
    if found is None:
        raise Http404
    return found
