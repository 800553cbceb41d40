"""A layer's statistics as files: the numbers as CSV, figures as SVG and PNG."""

from __future__ import annotations

from gtm_hit.metrics.coverage import Coverage
from gtm_hit.metrics.figures.png import png
from gtm_hit.ops.files.csv_text import csv_text
from gtm_hit.ops.quality.statistics.figures import figure
from gtm_hit.ops.quality.statistics.measuring import LayerStatistics
from gtm_hit.ops.quality.statistics.numbers import csv_header, csv_lines


def numbers_csv(found: LayerStatistics, ground: Coverage) -> str:
    return csv_text(csv_header(), csv_lines(found, ground))


def svg_figure(name: str, found: LayerStatistics, ground: Coverage) -> bytes:
    return figure(name, found, ground).encode()


def png_figure(name: str, found: LayerStatistics, ground: Coverage) -> bytes:
    return png(figure(name, found, ground))


PICTURES = {"svg": ("image/svg+xml", svg_figure), "png": ("image/png", png_figure)}
