"""Figures as SVG text, drawn as a paper prints them.

Text and lines have the colour of the page's text and the background is left out, so that one and the same
file suits paper and, placed in the page's HTML, a dark page. The same numbers give the same bytes.
"""

from gtm_hit.metrics.figures.camera_marks import CameraMark, camera_mark
from gtm_hit.metrics.figures.coverage_map import coverage_map
from gtm_hit.metrics.figures.curve import score_curve
from gtm_hit.metrics.figures.histogram import bars, histogram

__all__ = ["CameraMark", "bars", "camera_mark", "coverage_map", "histogram", "score_curve"]
