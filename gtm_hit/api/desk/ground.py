"""Measured points and where they are seen; poses follow by themselves."""

from __future__ import annotations

from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.parsing import BoundedJSONParser
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, WRITES, answers, caller
from gtm_hit.api.datasets.importing import FiniteField
from gtm_hit.api.desk.common import DeskFileParser, DeskView, desk_or_404, sent_file, told
from gtm_hit.ops.desk import clicks, edits, ground, pictures, points

PAGES = "`ground`, `check`, or `lens CAMERA`"


class GroundPointShape(serializers.Serializer[Any]):
    name = serializers.CharField()
    x = serializers.FloatField(help_text="metres")
    y = serializers.FloatField(help_text="metres")
    z = serializers.FloatField(help_text="metres")


class PointPlaceSerializer(serializers.Serializer[Any]):
    x = FiniteField(help_text="metres")
    y = FiniteField(help_text="metres")
    z = FiniteField(default=0.0, help_text="metres")


class GroundCameraShape(serializers.Serializer[Any]):
    name = serializers.CharField()
    width = serializers.IntegerField(help_text="pixels; 0: not known yet")
    height = serializers.IntegerField()
    light = serializers.CharField(help_text="digest of its picture; empty: none")
    full = serializers.CharField()
    lens = serializers.CharField(help_text="where its lens is from; empty: none")
    clicks = serializers.DictField(help_text="pixels x, y by the point's name")
    placed = serializers.DictField(allow_null=True, help_text="the calibrated camera; null: no pose")
    report = serializers.DictField(
        help_text="problem, rms, centre, centre_sigma, residuals, findings, ghosts"
    )


class StepsShape(serializers.Serializer[Any]):
    undo = serializers.CharField(help_text="what undoing would take back, in words; empty: nothing")
    redo = serializers.CharField()


class GroundShape(StepsShape):
    points = GroundPointShape(many=True)
    doubts = serializers.ListField(child=serializers.CharField(), help_text="what looks wrong about them")
    cameras = GroundCameraShape(many=True)


class OneGroundShape(StepsShape):
    camera = GroundCameraShape()


class PointsFileSerializer(serializers.Serializer[Any]):
    file = serializers.FileField(help_text="CSV or JSON")
    unit = serializers.ChoiceField(
        choices=["", "m", "cm", "mm"], default="", help_text="unless the file says it"
    )


class GridSerializer(serializers.Serializer[Any]):
    columns = serializers.IntegerField(min_value=1, max_value=LARGEST)
    rows = serializers.IntegerField(min_value=1, max_value=LARGEST)
    spacing_x = FiniteField(help_text="metres")
    spacing_y = FiniteField(help_text="metres")
    origin_x = FiniteField(default=0.0, help_text="metres")
    origin_y = FiniteField(default=0.0, help_text="metres")


class PixelSerializer(serializers.Serializer[Any]):
    x = FiniteField(help_text="pixels of the picture as taken")
    y = FiniteField()


class FrameChoiceSerializer(serializers.Serializer[Any]):
    frame = serializers.IntegerField(min_value=0, max_value=LARGEST, help_text="number, of the dataset")


class UndoSerializer(serializers.Serializer[Any]):
    page = serializers.CharField(max_length=100, default=edits.GROUND, help_text=PAGES)


class Ground(DeskView):
    @extend_schema(
        operation_id="desk_ground",
        summary="Points, clicks and poses",
        responses=answers(200, GroundShape, READS),
    )
    def get(self, request: Request, desk: str) -> Response:
        return Response(ground.whole(desk_or_404(request, desk)))


class PointsFile(DeskView):
    parser_classes = [DeskFileParser]

    @extend_schema(
        operation_id="put_desk_points",
        summary="All measured points out of a file",
        description="Points that stay by their name keep their clicks.",
        request={"multipart/form-data": PointsFileSerializer},
        responses=answers(200, GroundShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(PointsFileSerializer(data=request.data))
        with told("file"):
            file = wanted["file"]
            ground.put_file(found, file.read(), file.name or "points", wanted["unit"], caller(request))
        return Response(ground.whole(found))


class PointsGrid(DeskView):
    @extend_schema(
        operation_id="put_desk_grid",
        summary="All measured points as a regular grid",
        request=GridSerializer,
        responses=answers(200, GroundShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(GridSerializer(data=request.data))
        spacing, origin = ((wanted[f"{name}_x"], wanted[f"{name}_y"]) for name in ("spacing", "origin"))
        with told("columns"):
            ground.put_grid(found, wanted["columns"], wanted["rows"], spacing, origin, caller(request))
        return Response(ground.whole(found))


class OnePoint(DeskView):
    @extend_schema(
        operation_id="put_desk_point",
        summary="Add a measured point, or correct one",
        request=PointPlaceSerializer,
        responses=answers(200, GroundShape, WRITES),
    )
    def put(self, request: Request, desk: str, point: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(PointPlaceSerializer(data=request.data))
        with told("name"):
            points.put(found, point, wanted["x"], wanted["y"], wanted["z"], caller(request))
        return Response(ground.whole(found))

    @extend_schema(
        operation_id="remove_desk_point",
        summary="Remove a measured point with its clicks",
        responses=answers(200, GroundShape, READS),
    )
    def delete(self, request: Request, desk: str, point: str) -> Response:
        found = desk_or_404(request, desk)
        with told():
            points.remove(found, point, caller(request))
        return Response(ground.whole(found))


class OneClick(DeskView):
    @extend_schema(
        operation_id="put_desk_click",
        summary="Say where a camera sees a point",
        description="Saved at once; the camera's pose is solved again.",
        request=PixelSerializer,
        responses=answers(200, OneGroundShape, WRITES),
    )
    def put(self, request: Request, desk: str, camera: str, point: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(PixelSerializer(data=request.data))
        with told("x"):
            clicks.put(found, camera, point, wanted["x"], wanted["y"], caller(request))
            return Response(ground.one(found, camera))

    @extend_schema(
        operation_id="remove_desk_click",
        summary="Take a click away",
        responses=answers(200, OneGroundShape, READS),
    )
    def delete(self, request: Request, desk: str, camera: str, point: str) -> Response:
        found = desk_or_404(request, desk)
        with told():
            clicks.remove(found, camera, point, caller(request))
            return Response(ground.one(found, camera))


class PairsFile(DeskView):
    parser_classes = [DeskFileParser]

    @extend_schema(
        operation_id="put_desk_clicks",
        summary="Clicks of one camera out of a JSON file",
        description="Points that the desk lacks are added.",
        request={"multipart/form-data": PointsFileSerializer},
        responses=answers(200, GroundShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        wanted = valid(PointsFileSerializer(data=request.data))
        with told("file"):
            file, user = wanted["file"], caller(request)
            ground.put_pairs(found, camera, file.read(), file.name or "clicks", wanted["unit"], user)
        return Response(ground.whole(found))


class GroundPicture(DeskView):
    parser_classes = [DeskFileParser, BoundedJSONParser]

    @extend_schema(
        operation_id="put_desk_picture",
        summary="The picture in which points are clicked",
        description="As a file, or as the number of a frame of the desk's dataset.",
        request={"multipart/form-data": None, "application/json": FrameChoiceSerializer},
        responses=answers(200, OneGroundShape, WRITES),
    )
    def post(self, request: Request, desk: str, camera: str) -> Response:
        found = desk_or_404(request, desk)
        with told("file"):
            if request.content_type.startswith("multipart/"):
                data, _name = sent_file(request)
                pictures.put(found, camera, data, caller(request))
            else:
                number = valid(FrameChoiceSerializer(data=request.data))["frame"]
                pictures.put_frame(found, camera, number, caller(request))
            return Response(ground.one(found, camera))


class Undo(DeskView):
    @extend_schema(
        operation_id="undo_on_desk",
        summary="Take a page's latest step back",
        description="Nothing happens where there is none.",
        request=UndoSerializer,
        responses=answers(200, StepsShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        return _stepped(request, desk, edits.undo)


class Redo(DeskView):
    @extend_schema(
        operation_id="redo_on_desk",
        summary="Do again what was undone last",
        request=UndoSerializer,
        responses=answers(200, StepsShape, WRITES),
    )
    def post(self, request: Request, desk: str) -> Response:
        return _stepped(request, desk, edits.redo)


def _stepped(request: Request, slug: str, step: Any) -> Response:
    desk = desk_or_404(request, slug)
    page = valid(UndoSerializer(data=request.data))["page"]
    with told("page"):
        step(desk, page)
    found = edits.steps(desk, page)
    return Response({"undo": found.undo, "redo": found.redo})
