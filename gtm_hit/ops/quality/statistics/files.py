"""A layer's statistics as files: the numbers as CSV, figures as SVG and PNG."""

from __future__ import annotations

import csv
import io

from gtm_hit.metrics.coverage import Coverage
from gtm_hit.metrics.figures.png import png
from gtm_hit.ops.quality.statistics.figures import figure
from gtm_hit.ops.quality.statistics.measuring import LayerStatistics
from gtm_hit.ops.quality.statistics.numbers import csv_header, csv_lines


def numbers_csv(found: LayerStatistics, ground: Coverage) -> str:
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(csv_header())
    writer.writerows(csv_lines(found, ground))
    return stream.getvalue()


def svg_figure(name: str, found: LayerStatistics, ground: Coverage) -> bytes:
    return figure(name, found, ground).encode()


def png_figure(name: str, found: LayerStatistics, ground: Coverage) -> bytes:
    return png(figure(name, found, ground))


PICTURES = {"svg": ("image/svg+xml", svg_figure), "png": ("image/png", png_figure)}
