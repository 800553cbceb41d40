"""Datasets and what belongs to them, for reading."""

from __future__ import annotations

from typing import Any

from django.db.models import Prefetch, QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api import shapes
from gtm_hit.api.staff import (
    ASKS,
    READS,
    Pages,
    StaffView,
    answers,
    asked,
    dataset_or_404,
    layer_or_404,
)
from gtm_hit.models import Camera, Dataset, Frame, Image, Layer
from gtm_hit.ops import overview
from gtm_hit.ops.placed import placed


class Datasets(StaffView, ListAPIView[Dataset]):
    queryset = Dataset.objects.order_by("slug")
    serializer_class = shapes.DatasetShape
    pagination_class = Pages

    @extend_schema(
        operation_id="datasets",
        summary="All datasets",
        responses=answers(200, shapes.DatasetShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class OneDataset(StaffView):
    @extend_schema(
        operation_id="dataset", summary="A dataset", responses=answers(200, shapes.DatasetShape, READS)
    )
    def get(self, request: Request, slug: str) -> Response:
        return Response(shapes.DatasetShape(dataset_or_404(slug)).data)


class Cameras(StaffView, ListAPIView[Camera]):
    queryset = Camera.objects.none()
    serializer_class = shapes.CameraShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Camera]:
        return dataset_or_404(self.kwargs["slug"]).cameras.order_by("index")

    @extend_schema(
        operation_id="cameras",
        summary="Calibrated cameras of a dataset",
        responses=answers(200, shapes.CameraShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class Frames(StaffView, ListAPIView[Frame]):
    queryset = Frame.objects.none()
    serializer_class = shapes.FrameShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Frame]:
        wanted = asked(self.request, shapes.NumbersQuery)
        images = Image.objects.select_related("camera").order_by("camera__index")
        return (
            dataset_or_404(self.kwargs["slug"])
            .frames.filter(number__gte=wanted["from"], number__lte=wanted["to"])
            .order_by("number")
            .prefetch_related(Prefetch("images", images))
        )

    @extend_schema(
        operation_id="frames",
        summary="Frames with the addresses of their images",
        parameters=[shapes.NumbersQuery],
        responses=answers(200, shapes.FrameShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class Layers(StaffView, ListAPIView[Layer]):
    queryset = Layer.objects.none()
    serializer_class = shapes.LayerShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Layer]:
        wanted = asked(self.request, shapes.LayersQuery)
        return overview.layers(dataset_or_404(self.kwargs["slug"])).filter(**wanted)

    @extend_schema(
        operation_id="layers",
        summary="Layers with their counts",
        parameters=[shapes.LayersQuery],
        responses=answers(200, shapes.LayerShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class OneLayer(StaffView):
    @extend_schema(operation_id="layer", summary="A layer", responses=answers(200, shapes.LayerShape, READS))
    def get(self, request: Request, slug: str, name: str) -> Response:
        layer = layer_or_404(slug, name)
        return Response(shapes.LayerShape(overview.layers(layer.dataset).get(pk=layer.pk)).data)


class Annotations(StaffView):
    @extend_schema(
        operation_id="annotations",
        summary="Annotations of a layer, frame by frame",
        description="`next` leads on to the frames that follow, until it is null.",
        parameters=[shapes.PlacedQuery],
        responses=answers(200, shapes.PlacedPageSerializer, ASKS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        layer = layer_or_404(slug, name)
        wanted = asked(request, shapes.PlacedQuery)
        rows, following = placed(layer, wanted["from"], wanted["to"], wanted["frames"])
        return Response({"next": self._address(request, following), "results": rows})

    def _address(self, request: Request, following: int | None) -> str | None:
        if following is None:
            return None
        query = request.query_params.copy()
        query["from"] = str(following)
        return request.build_absolute_uri(f"{request.path}?{query.urlencode()}")
