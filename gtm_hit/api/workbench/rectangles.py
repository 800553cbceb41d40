"""Boxes of people of any size: the table that a browser has holds the usual one only."""

from __future__ import annotations

from typing import Any

import numpy as np
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import REFUSALS, refusal, valid
from gtm_hit.api.workbench.places import PlacedView
from gtm_hit.geometry.cylinder import HEIGHTS, RADII
from gtm_hit.models import Dataset
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.ground.rectangles import annotation_rectangles

MOST_PEOPLE = 500


class SizedSerializer(serializers.Serializer[Any]):
    position = serializers.IntegerField(min_value=0)
    height = serializers.FloatField(min_value=HEIGHTS[0], max_value=HEIGHTS[1], allow_null=True)
    radius = serializers.FloatField(min_value=RADII[0], max_value=RADII[1], allow_null=True)


class PeopleSerializer(serializers.Serializer[Any]):
    people = serializers.ListField(child=SizedSerializer(), max_length=MOST_PEOPLE)


class RectanglesSerializer(serializers.Serializer[Any]):
    rectangles = serializers.JSONField(
        help_text="per person and camera [xmin, ymin, xmax, ymax], null where not visible"
    )


class RectanglesView(PlacedView):
    @extend_schema(
        summary="Boxes of people of any size",
        request=PeopleSerializer,
        responses={200: RectanglesSerializer, 400: refusal("invalid"), **REFUSALS},
    )
    def post(self, request: Request, **kwargs: Any) -> Response:
        dataset = self.place(**kwargs).dataset
        people = valid(PeopleSerializer(data=request.data))["people"]
        if any(not dataset.grid.contains(one["position"]) for one in people):
            raise serializers.ValidationError({"people": "A position is not on the grid."})
        return Response({"rectangles": _boxes(dataset, people) if people else []})


def _boxes(dataset: Dataset, people: list[dict[str, Any]]) -> list[list[list[int] | None]]:
    def column(name: str) -> np.ndarray:
        return np.array([np.nan if one[name] is None else one[name] for one in people])

    positions = [one["position"] for one in people]
    cameras = dataset.calibrated_cameras()
    boxes, visible = annotation_rectangles(
        dataset, cameras, table(dataset), positions, column("height"), column("radius")
    )
    return [
        [box if shown else None for box, shown in zip(*row, strict=True)]
        for row in zip(boxes.tolist(), visible.tolist(), strict=True)
    ]
