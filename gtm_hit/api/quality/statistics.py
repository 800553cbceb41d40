"""What a paper prints of a layer: as JSON, as a table, as figures."""

from __future__ import annotations

from typing import Any

from django.http import Http404, HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiExample, OpenApiParameter, OpenApiResponse, extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.staff import ASKS, StaffView, answers, asked, invalid, layer_or_404
from gtm_hit.api.jobs import Download
from gtm_hit.metrics.coverage import Coverage
from gtm_hit.models import Layer
from gtm_hit.ops.quality.statistics.figures import FIGURES
from gtm_hit.ops.quality.statistics.files import PICTURES, numbers_csv
from gtm_hit.ops.quality.statistics.measuring import (
    EVERY,
    LayerStatistics,
    ground_coverage,
    layer_statistics,
    unmeasurable,
)
from gtm_hit.ops.quality.statistics.numbers import as_numbers

EXAMPLE = OpenApiExample(
    "a hall seen by seven cameras; distributions but one left out",
    {
        "dataset": "WILDTRACK",
        "layer": "truth",
        "frames": 400,
        "people": 313,
        "annotations": 9518,
        "visible_per_view": {"C1": 5100, "C2": 6120},
        "visible_in_exactly": [0, 210, 1890, 7418],
        "views_per_annotation": 3.74,
        "speed": {"count": 9205, "mean": 0.9, "least": 0.0, "median": 0.8, "most": 3.4},
        "coverage": {
            "every": 8,
            "positions": 10800,
            "seen_by_exactly": [0, 77, 2481, 2458, 1625, 1735, 2095, 329],
            "mean": 3.93,
        },
    },
)


MOST_EVERY = 10_000


class CoverageQuery(serializers.Serializer[Any]):
    every = serializers.IntegerField(
        min_value=1, max_value=MOST_EVERY, default=EVERY, help_text="coverage: every n-th position"
    )


def measured(request: Request, slug: str, name: str) -> tuple[Layer, LayerStatistics, Coverage]:
    layer = layer_or_404(request, slug, name)
    every = asked(request, CoverageQuery)["every"]
    if not layer.dataset.cameras.exists():
        raise Http404
    if reason := unmeasurable(layer.dataset):
        raise invalid("", reason)
    return layer, layer_statistics(layer), ground_coverage(layer.dataset, every)


class Statistics(StaffView):
    @extend_schema(
        operation_id="statistics",
        summary="What a paper prints of a layer",
        description="Metres and seconds; what is not defined is null.",
        parameters=[CoverageQuery],
        responses=answers(200, OpenApiResponse(OpenApiTypes.OBJECT, examples=[EXAMPLE]), ASKS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        _layer, found, ground = measured(request, slug, name)
        return Response(as_numbers(found, ground))


class StatisticsTable(Download):
    @extend_schema(
        operation_id="statistics_table",
        summary="All numbers behind the statistics and their figures, as CSV",
        description="Columns: quantity, of what, value, unit.",
        parameters=[CoverageQuery],
        responses={(200, "text/csv"): OpenApiTypes.STR, **ASKS},
    )
    def get(self, request: Request, slug: str, name: str) -> HttpResponse:
        layer, found, ground = measured(request, slug, name)
        return attachment(numbers_csv(found, ground), "text/csv; charset=utf-8", f"{slug}-{layer.name}.csv")


class StatisticsFigure(Download):
    @extend_schema(
        operation_id="statistics_figure",
        summary="A figure of the statistics, as SVG or PNG",
        parameters=[
            OpenApiParameter("figure", str, OpenApiParameter.PATH, enum=list(FIGURES)),
            OpenApiParameter("kind", str, OpenApiParameter.PATH, enum=list(PICTURES)),
            CoverageQuery,
        ],
        responses={
            (200, "image/svg+xml"): OpenApiTypes.STR,
            (200, "image/png"): OpenApiTypes.BINARY,
            **ASKS,
        },
    )
    def get(self, request: Request, slug: str, name: str, figure: str, kind: str) -> HttpResponse:
        if figure not in FIGURES or kind not in PICTURES:
            raise Http404
        layer, found, ground = measured(request, slug, name)
        content_type, draw = PICTURES[kind]
        return attachment(draw(figure, found, ground), content_type, f"{slug}-{layer.name}-{figure}.{kind}")


def attachment(content: Any, content_type: str, name: str) -> HttpResponse:
    """Slugs and layer names hold nothing that would need quoting."""
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return HttpResponse(content, content_type=content_type, headers=headers)
