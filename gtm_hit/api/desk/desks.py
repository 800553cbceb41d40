"""Desks: made, listed, looked at as a whole, removed; and their cameras and pictures."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import FileResponse, Http404, HttpResponseNotModified
from django.http.response import HttpResponseBase
from django.utils.cache import get_conditional_response
from django.utils.translation import gettext_lazy
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, WRITES, Pages, answers, caller, invalid
from gtm_hit.api.desk.common import DeskView, desk_or_404, told
from gtm_hit.api.workbench.images import ImageView
from gtm_hit.models import Dataset, Desk
from gtm_hit.models.dataset import name_validator
from gtm_hit.ops.access.desks import desks_of, may_make_desk
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import checks, desks, overview, pictures

NOT_YOURS = gettext_lazy("You look after no such dataset; without one it takes a maintainer of all datasets.")


class NewDeskSerializer(serializers.Serializer[Any]):
    slug = serializers.SlugField(max_length=80, help_text="the desk's name in addresses")
    title = serializers.CharField(max_length=200, default="", allow_blank=True)
    dataset = serializers.SlugField(
        max_length=80, allow_null=True, default=None, help_text="null: for a dataset that is not there yet"
    )
    cameras = serializers.ListField(
        child=serializers.CharField(max_length=80, validators=[name_validator]),
        default=list,
        max_length=desks.MOST_CAMERAS,
        help_text="names, without a dataset",
    )


class DeskShape(serializers.ModelSerializer[Desk]):
    dataset = serializers.CharField(source="dataset.slug", default=None, allow_null=True)
    created_by = serializers.CharField(source="created_by.username", default=None, allow_null=True)

    class Meta:
        model = Desk
        fields = ["slug", "title", "dataset", "created_by", "created_at"]


class DeskStepShape(serializers.Serializer[Any]):
    verdict = serializers.ChoiceField(choices=[each.value for each in overview.Verdict])
    words = serializers.CharField()


class CameraStepsShape(serializers.Serializer[Any]):
    name = serializers.CharField()
    lens = DeskStepShape()
    ground = DeskStepShape()


class WholeDeskShape(DeskShape):
    cameras = CameraStepsShape(many=True)
    adjust = DeskStepShape(help_text="of all cameras together")
    check = DeskStepShape(help_text="what its test points tell")
    next_step = serializers.CharField(help_text="the one next step, in words")

    class Meta(DeskShape.Meta):
        fields = [*DeskShape.Meta.fields, "cameras", "adjust", "check", "next_step"]


class NewDeskCameraSerializer(serializers.Serializer[Any]):
    name = serializers.CharField(max_length=80, validators=[name_validator])


class Desks(DeskView, ListAPIView[Desk]):
    queryset = Desk.objects.none()
    serializer_class = DeskShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Desk]:
        return desks_of(caller(self.request)).select_related("dataset", "created_by")

    @extend_schema(
        operation_id="calibration_desks",
        summary="Calibrations being made, the newest first",
        responses=answers(200, DeskShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)

    @extend_schema(
        operation_id="new_calibration_desk",
        summary="Begin a calibration",
        description="Of a dataset's cameras, or of cameras for a dataset that will be imported with them.",
        request=NewDeskSerializer,
        responses=answers(201, WholeDeskShape, WRITES),
    )
    def post(self, request: Request) -> Response:
        wanted = valid(NewDeskSerializer(data=request.data))
        dataset = Dataset.objects.filter(slug=wanted["dataset"]).first() if wanted["dataset"] else None
        if (wanted["dataset"] and dataset is None) or not may_make_desk(caller(request), dataset):
            raise invalid("dataset", NOT_YOURS)
        with told("slug"):
            desk = desks.make(wanted["slug"], wanted["title"], dataset, wanted["cameras"], caller(request))
        return Response(_whole(desk), status=201)


class OneDesk(DeskView):
    @extend_schema(
        operation_id="calibration_desk",
        summary="A desk: how far each camera is, how good, and the next step",
        responses=answers(200, WholeDeskShape, READS),
    )
    def get(self, request: Request, desk: str) -> Response:
        return Response(_whole(desk_or_404(request, desk)))

    @extend_schema(
        operation_id="remove_calibration_desk",
        summary="Remove a desk with everything on it",
        description="What was put in place stays.",
        responses={204: None, **READS},
    )
    def delete(self, request: Request, desk: str) -> Response:
        desks.remove(desk_or_404(request, desk))
        return Response(status=204)


class DeskCameras(DeskView):
    @extend_schema(
        operation_id="add_desk_camera",
        summary="Add a camera to a desk without a dataset",
        request=NewDeskCameraSerializer,
        responses=answers(201, WholeDeskShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        with told("name"):
            desks.add_camera(found, valid(NewDeskCameraSerializer(data=request.data))["name"])
        return Response(_whole(found), status=201)


class OneDeskCamera(DeskView):
    @extend_schema(
        operation_id="remove_desk_camera",
        summary="Remove a camera that nothing was done for yet",
        responses={204: None, **WRITES},
    )
    def delete(self, request: Request, desk: str, camera: str) -> Response:
        with told("camera"):
            desks.remove_camera(desk_or_404(request, desk), camera)
        return Response(status=204)


class DeskImage(ImageView):
    """As a dataset's pictures are served, for those who may see the desk."""

    read_role = Role.MAINTAINER
    authentication_classes = DeskView.authentication_classes
    permission_classes = DeskView.permission_classes

    @extend_schema(
        operation_id="desk_picture",
        summary="A picture of a desk",
        parameters=[OpenApiParameter("digest", str, OpenApiParameter.PATH, description="SHA-256, 64 digits")],
        responses={(200, "image/jpeg"): OpenApiTypes.BINARY, **READS},
    )
    def get(self, request: Request, desk: str, digest: str) -> HttpResponseBase:  # type: ignore[override]
        if not pictures.shows(desk_or_404(request, desk), digest):
            raise Http404
        etag = f'"{digest}"'
        response = get_conditional_response(request._request, etag=etag) or self.file(digest)
        if isinstance(response, FileResponse | HttpResponseNotModified):
            return self.kept_for_ever(response, etag)
        return response


def _whole(desk: Desk) -> dict[str, Any]:
    found = overview.overview(desk)
    cameras = CameraStepsShape(found.cameras, many=True).data
    check = DeskStepShape(checks.step(desk)).data
    return {
        **DeskShape(desk).data,
        "cameras": cameras,
        "adjust": DeskStepShape(found.adjust).data,
        "check": check,
        "next_step": found.next_step.words,
    }
