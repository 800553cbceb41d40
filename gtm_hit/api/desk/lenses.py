"""The lens of a desk's camera: what it is, and putting one there that is known already."""

from __future__ import annotations

from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, WRITES, answers, caller
from gtm_hit.api.datasets.importing import FiniteField
from gtm_hit.api.desk.common import (
    DeskFileParser,
    DeskView,
    FileOfDeskSerializer,
    desk_or_404,
    sent_file,
    told,
)
from gtm_hit.models import Desk
from gtm_hit.ops.desk import lenses


class LensNumbersSerializer(serializers.Serializer[Any]):
    width = serializers.IntegerField(min_value=1, max_value=LARGEST, help_text="of the pictures, pixels")
    height = serializers.IntegerField(min_value=1, max_value=LARGEST)
    matrix = serializers.ListField(
        child=serializers.ListField(child=FiniteField(), min_length=3, max_length=3),
        min_length=3,
        max_length=3,
        help_text="[[fx, 0, cx], [0, fy, cy], [0, 0, 1]], pixels",
    )
    distortion = serializers.ListField(
        child=FiniteField(), max_length=14, help_text="4, 5, 8, 12 or 14 numbers in OpenCV's order"
    )
    source = serializers.CharField(  # type: ignore[assignment]
        max_length=200, default="numbers sent", help_text="where they are from, in words"
    )


class DeskLensShape(serializers.Serializer[Any]):
    width = serializers.IntegerField(help_text="pixels; 0: not known yet")
    height = serializers.IntegerField()
    lens = serializers.DictField(allow_null=True, help_text="matrix, distortion, source")
    report = serializers.DictField(help_text="of the solve it is from; empty where it was given")


class DeskLens(DeskView):
    @extend_schema(
        operation_id="desk_lens",
        summary="The lens of a camera, and how good it is",
        responses=answers(200, DeskLensShape, READS),
    )
    def get(self, request: Request, desk: str, camera: str) -> Response:
        with told():
            return Response(lens_answer(desk_or_404(request, desk), camera))

    @extend_schema(
        operation_id="put_desk_lens",
        summary="Use a lens whose numbers are known",
        request=LensNumbersSerializer,
        responses=answers(200, DeskLensShape, WRITES),
    )
    def put(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        given = valid(LensNumbersSerializer(data=request.data))
        size = (given["width"], given["height"])
        with told("matrix"):
            lenses.put(
                found, camera, size, given["matrix"], given["distortion"], given["source"], caller(request)
            )
            return Response(lens_answer(found, camera))


class DeskLensFile(DeskView):
    parser_classes = [DeskFileParser]

    @extend_schema(
        operation_id="put_desk_lens_file",
        summary="Use the lens of a file",
        description="A cameras.json, or an intrinsic file in OpenCV's XML or YAML.",
        request={"multipart/form-data": FileOfDeskSerializer},
        responses=answers(200, DeskLensShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        data, name = sent_file(request)
        with told("file"):
            lenses.put_file(found, camera, data, name, caller(request))
            return Response(lens_answer(found, camera))


class DeskLensInPlace(DeskView):
    @extend_schema(
        operation_id="take_lens_in_place",
        summary="Use the lens that the dataset has in place",
        request=None,
        responses=answers(200, DeskLensShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        with told():
            lenses.put_in_place(found, camera, caller(request))
            return Response(lens_answer(found, camera))


def lens_answer(desk: Desk, camera: str) -> dict[str, Any]:
    row = lenses.camera_of(desk, camera)
    return {"width": row.width, "height": row.height, "lens": row.lens, "report": row.lens_report}
