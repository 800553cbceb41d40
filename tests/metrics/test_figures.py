from __future__ import annotations

import math
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics import detection
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.metrics.coverage import Coverage, coverage
from gtm_hit.metrics.figures import CameraMark, bars, coverage_map, histogram, score_curve
from tests.metrics.scenes import crossing_people

SVG = "{http://www.w3.org/2000/svg}"
NAMES = {"title": "Height", "x_label": "height (m)", "y_label": "people"}


def drawn(text: str) -> ElementTree.Element:
    assert not re.search(r"\b(nan|inf)\b", text)
    return ElementTree.fromstring(text)


def words(text: str) -> list[str]:
    return [element.text or "" for element in drawn(text).iter(f"{SVG}text")]


def heights_of_bars(text: str) -> list[float]:
    return [float(element.attrib["height"]) for element in drawn(text).iter(f"{SVG}rect")]


def area(path: str) -> int:
    """Cells covered by a path of rectangles `Mx yhWvHh-Wz`."""
    return sum(int(w) * int(h) for w, h in re.findall(r"h(\d+)v(\d+)h-", path))


def small_coverage() -> Coverage:
    rng = np.random.default_rng(5)
    return coverage(Grid(12, 40, 0.25, -3.0, -9.0), rng.random((4, 480)) < 0.6)


def curve_of(wobble: float = 0.2) -> list[detection.DetectionScore]:
    return detection.curve(*crossing_people(wobble=wobble))


def test_bars_are_as_high_as_their_counts() -> None:
    tallest, middle, lowest = heights_of_bars(bars(["C1", "C2", "C3"], [40, 20, 10], **NAMES))
    assert tallest / middle == pytest.approx(2, abs=0.01)
    assert middle / lowest == pytest.approx(2, abs=0.01)


def test_bars_carry_their_names_and_counts() -> None:
    assert {"C1", "C2", "1,200", "7"} <= set(words(bars(["C1", "C2"], [1200, 7], **NAMES)))


def test_long_names_are_tilted_instead_of_overlapping() -> None:
    assert "rotate(-40)" in bars([f"Camera{i}" for i in range(12)], range(1, 13), **NAMES)


def test_whole_numbers_get_a_bar_each() -> None:
    text = histogram([1, 2, 2, 5, 6, 7, 8, 8], **NAMES, whole=True)
    assert len(heights_of_bars(text)) == 6


def test_the_median_is_told() -> None:
    assert "median 1.75" in words(histogram([1.7, 1.75, 1.9], **NAMES, decimals=2))


def test_nothing_is_said_to_be_nothing() -> None:
    assert "nothing to show" in words(histogram([], **NAMES))
    assert "nothing to show" in words(bars([], [], **NAMES))


@example([0.0, 5e-324], False)
@example([1e6, 1e6 + 1e-10], False)
@given(st.lists(st.floats(-1e6, 1e6), max_size=30), st.booleans())
def test_any_values_make_a_drawing_that_holds_all_of_them(values: list[float], whole: bool) -> None:
    text = histogram(values, **NAMES, whole=whole)
    if values:
        assert f"{len(values)} values" in text
        assert heights_of_bars(text)


@given(st.text(max_size=20))
def test_any_title_is_written_so_that_it_cannot_break_the_drawing(title: str) -> None:
    text = bars(["a"], [1], title=title, x_label="x", y_label="y")
    assert not re.search(r"[\x00-\x08\x0b\x0c\x0e-\x1f]", text)
    drawn(text)


def test_each_shade_covers_the_positions_seen_by_as_many_cameras_or_more() -> None:
    seen = small_coverage()
    paths = [element.attrib["d"] for element in drawn(coverage_map(seen, title="Map")).iter(f"{SVG}path")]
    at_least = [int((seen.seen_by >= count).sum()) for count in (1, 2, 3, 4)]
    assert [area(path) for path in paths] == at_least


def test_shades_grow_darker_with_every_camera() -> None:
    paths = drawn(coverage_map(small_coverage(), title="Map")).iter(f"{SVG}path")
    fills = [element.attrib["fill"] for element in paths]
    light = [0.3 * int(f[1:3], 16) + 0.59 * int(f[3:5], 16) + 0.11 * int(f[5:7], 16) for f in fills]
    assert light == sorted(light, reverse=True)
    assert len(set(light)) == 4


def test_the_map_tells_the_counts_and_the_mean() -> None:
    seen = small_coverage()
    told = words(coverage_map(seen, title="Map"))
    assert f"mean {seen.mean:.2f}" in told and "of 480" in told
    assert {str(count) for count in seen.counts.tolist()} <= set(told)


def test_a_long_grid_lies_on_its_side_with_x_growing_downwards() -> None:
    # Only the first row of positions is seen: the smallest Y, so the leftmost column of cells.
    visible = np.zeros(480, dtype=bool)
    visible[:12] = True
    text = coverage_map(coverage(Grid(12, 40, 0.25, 0.0, 0.0), [visible]), title="Map")
    assert [element.attrib["d"] for element in drawn(text).iter(f"{SVG}path")] == ["M0 0h1v12h-1z"]


def test_a_wide_grid_has_y_growing_upwards() -> None:
    visible = np.zeros(480, dtype=bool)
    visible[:40] = True
    text = coverage_map(coverage(Grid(40, 12, 0.25, 0.0, 0.0), [visible]), title="Map")
    assert [element.attrib["d"] for element in drawn(text).iter(f"{SVG}path")] == ["M0 11h40v1h-40z"]


def test_cameras_on_one_pole_are_both_named_without_hiding_each_other() -> None:
    marks = [CameraMark("C1", 2.0, 0.0, (0.0, 4.0)), CameraMark("C4", 2.0, 0.01, (0.0, 3.0))]
    root = drawn(coverage_map(small_coverage(), marks, title="Map"))
    plates = [element.attrib for element in root.iter(f"{SVG}rect") if "rx" in element.attrib]
    (left, top, width, height), (x, y, *_) = (
        [float(plate[key]) for key in ("x", "y", "width", "height")] for plate in plates
    )
    assert x >= left + width or x + width <= left or y >= top + height or y + height <= top


def test_a_camera_far_away_does_not_shrink_the_map() -> None:
    far = CameraMark("far", 500.0, 500.0)
    assert coverage_map(small_coverage(), [far], title="Map") == coverage_map(small_coverage(), title="Map")


def test_the_curve_goes_through_the_scores() -> None:
    scores = curve_of()
    lines = list(drawn(score_curve(scores, title="Scores")).iter(f"{SVG}polyline"))
    assert len(lines) == 4
    moda = [float(point.split(",")[1]) for point in lines[-1].attrib["points"].split()]
    assert len(moda) == len(scores)
    # Higher scores are higher up, that is at smaller y.
    assert np.argmin(moda) == np.argmax([score.moda for score in scores])


def test_undefined_scores_leave_a_gap() -> None:
    truth = Annotations([0, 0], [[0, 0], [5, 0]])
    found = Annotations([0, 0], [[0.3, 0], [5.3, 0]])
    scores = detection.curve(truth, found, (0.1, 0.2, 0.5, 1.0))
    assert math.isnan(scores[0].modp)
    modp = list(drawn(score_curve(scores, title="Scores")).iter(f"{SVG}polyline"))[-2]
    assert len(modp.attrib["points"].split()) == 2


def test_the_curve_tells_the_scores_at_the_marked_radius() -> None:
    scores = curve_of()
    at = next(score for score in scores if score.radius == 0.5)
    description = drawn(score_curve(scores, title="Scores")).findtext(f"{SVG}desc")
    assert description is not None and f"MODA {at.moda:.3f}" in description


def test_the_same_numbers_give_the_same_bytes() -> None:
    assert coverage_map(small_coverage(), title="Map") == coverage_map(small_coverage(), title="Map")
    assert score_curve(curve_of(), title="Scores") == score_curve(curve_of(), title="Scores")


def test_figures_carry_no_colour_of_a_page_and_load_nothing() -> None:
    for text in (coverage_map(small_coverage(), title="Map"), score_curve(curve_of(), title="Scores")):
        assert "currentColor" in text
        assert not re.search(r"href|url\(|<style|<script|@import", text)
