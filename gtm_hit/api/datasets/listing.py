"""Datasets and what belongs to them, for reading."""

from __future__ import annotations

from typing import Any

from django.db.models import Prefetch, QuerySet
from drf_spectacular.utils import OpenApiExample, extend_schema, extend_schema_field, extend_schema_serializer
from rest_framework import serializers
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.staff import (
    ASKS,
    READS,
    Pages,
    StaffView,
    answers,
    asked,
    caller,
    dataset_or_404,
    layer_or_404,
)
from gtm_hit.api.workbench.frames import AnnotationSerializer
from gtm_hit.api.workbench.scene import CameraShape, ImageRefSerializer, image_url
from gtm_hit.models import Camera, Dataset, Frame, Image, Layer
from gtm_hit.ops import overview
from gtm_hit.ops.access.roles import datasets_of, readable
from gtm_hit.ops.frames.metres import placed

MOST_FRAMES = 500  # whose annotations come in one answer


class DatasetShape(serializers.ModelSerializer[Dataset]):
    class Meta:
        model = Dataset
        fields = [
            *("slug", "name", "columns", "rows", "step", "origin_x", "origin_y"),
            *("cylinder_radius", "cylinder_height", "foot_rule", "frame_rate", "frame_step"),
            *("annotation_offset", "annotation_digits", "undistorted", "instructions", "created_at"),
        ]


class FrameShape(serializers.ModelSerializer[Frame]):
    images = serializers.SerializerMethodField()

    class Meta:
        model = Frame
        fields = ["number", "images"]

    @extend_schema_field(ImageRefSerializer(many=True))
    def get_images(self, frame: Frame) -> list[dict[str, Any]]:
        return [
            {
                "camera": image.camera.index,
                "light": image_url(image.light_digest),
                "full": image_url(image.full_digest),
            }
            for image in frame.images.all()
        ]


class LayerShape(serializers.ModelSerializer[Layer]):
    frames_saved = serializers.IntegerField()
    frames_done = serializers.IntegerField()
    annotations = serializers.IntegerField(source="annotation_count")
    people = serializers.IntegerField()
    changed_at = serializers.DateTimeField(allow_null=True)

    class Meta:
        model = Layer
        fields = [
            *("id", "name", "kind", "hidden", "frames_saved", "frames_done", "annotations", "people"),
            *("created_at", "changed_at"),
        ]


class PlacedSerializer(AnnotationSerializer):
    """One person of one frame."""

    frame = serializers.IntegerField(help_text="frame number")
    x = serializers.FloatField(help_text="metres")
    y = serializers.FloatField(help_text="metres")


@extend_schema_serializer(
    examples=[
        OpenApiExample(
            "two people of one frame",
            {
                "next": "https://marker.example/api/v1/datasets/square/layers/truth/annotations/?from=1",
                "results": [
                    {
                        "frame": 0,
                        "person": 12,
                        "position": 456826,
                        "x": 6.65,
                        "y": 14.775,
                        "state": "validated",
                        "origin": "clicked",
                        "height": None,
                        "radius": None,
                    }
                ],
            },
            response_only=True,
        )
    ]
)
class PlacedPageSerializer(serializers.Serializer[Any]):
    next = serializers.URLField(allow_null=True)
    results = PlacedSerializer(many=True)


class NumbersQuery(serializers.Serializer[Any]):
    """`from` and `to`, both included."""

    def get_fields(self) -> dict[str, Any]:
        # `from` cannot be an attribute's name.
        bounds: dict[str, Any] = {"min_value": 0, "max_value": LARGEST}
        return {
            "from": serializers.IntegerField(**bounds, default=0, help_text="first frame number"),
            "to": serializers.IntegerField(**bounds, default=LARGEST, help_text="last frame number"),
            **super().get_fields(),
        }


class PlacedQuery(NumbersQuery):
    frames = serializers.IntegerField(
        min_value=1, max_value=MOST_FRAMES, default=100, help_text="frames in one answer"
    )


class LayersQuery(serializers.Serializer[Any]):
    kind = serializers.ChoiceField(choices=Layer.Kind.choices, required=False)


class Datasets(StaffView, ListAPIView[Dataset]):
    queryset = Dataset.objects.none()
    serializer_class = DatasetShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Dataset]:
        return datasets_of(caller(self.request)).order_by("slug")

    @extend_schema(
        operation_id="datasets",
        summary="The datasets one has to do with",
        responses=answers(200, DatasetShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class OneDataset(StaffView):
    @extend_schema(operation_id="dataset", summary="A dataset", responses=answers(200, DatasetShape, READS))
    def get(self, request: Request, slug: str) -> Response:
        return Response(DatasetShape(dataset_or_404(slug)).data)


class Cameras(StaffView, ListAPIView[Camera]):
    queryset = Camera.objects.none()
    serializer_class = CameraShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Camera]:
        return dataset_or_404(self.kwargs["slug"]).cameras.order_by("index")

    @extend_schema(
        operation_id="cameras",
        summary="Calibrated cameras of a dataset",
        responses=answers(200, CameraShape(many=True), READS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class Frames(StaffView, ListAPIView[Frame]):
    queryset = Frame.objects.none()
    serializer_class = FrameShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Frame]:
        wanted = asked(self.request, NumbersQuery)
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
        parameters=[NumbersQuery],
        responses=answers(200, FrameShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class Layers(StaffView, ListAPIView[Layer]):
    queryset = Layer.objects.none()
    serializer_class = LayerShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Layer]:
        wanted = asked(self.request, LayersQuery)
        found = overview.layers(dataset_or_404(self.kwargs["slug"]))
        return found.filter(readable(caller(self.request)), **wanted)

    @extend_schema(
        operation_id="layers",
        summary="Layers with their counts",
        parameters=[LayersQuery],
        responses=answers(200, LayerShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class OneLayer(StaffView):
    @extend_schema(operation_id="layer", summary="A layer", responses=answers(200, LayerShape, READS))
    def get(self, request: Request, slug: str, name: str) -> Response:
        layer = layer_or_404(request, slug, name)
        return Response(LayerShape(overview.layers(layer.dataset).get(pk=layer.pk)).data)


class Annotations(StaffView):
    @extend_schema(
        operation_id="annotations",
        summary="Annotations of a layer, frame by frame",
        description="`next` leads on to the frames that follow, until it is null.",
        parameters=[PlacedQuery],
        responses=answers(200, PlacedPageSerializer, ASKS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        layer = layer_or_404(request, slug, name)
        wanted = asked(request, PlacedQuery)
        rows, following = placed(layer, wanted["from"], wanted["to"], wanted["frames"])
        results = [row.as_dict() for row in rows]
        return Response({"next": self._address(request, following), "results": results})

    def _address(self, request: Request, following: int | None) -> str | None:
        if following is None:
            return None
        query = request.query_params.copy()
        query["from"] = str(following)
        return request.build_absolute_uri(f"{request.path}?{query.urlencode()}")
