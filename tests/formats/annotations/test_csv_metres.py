from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.formats.annotations.csv_metres import GroundPoints, csv_header, csv_lines, parse_csv
from gtm_hit.formats.problems import FormatError


def parse(text: str) -> GroundPoints:
    return parse_csv(text.encode(), "a.csv")


def problems_of(text: str) -> list[str]:
    with pytest.raises(FormatError) as caught:
        parse(text)
    return [str(problem) for problem in caught.value.problems]


def test_people_are_read_with_the_lines_they_stand_on() -> None:
    points = parse("# by hand\nframe,person,x,y\n\n5,3,5.65,-9\n10,3,-1e-1,.5\n")
    assert points.frames.tolist() == [5, 10]
    assert points.xy.tolist() == [[5.65, -9.0], [-0.1, 0.5]]
    assert points.persons is not None and points.persons.tolist() == [3, 3]
    assert points.lines is not None and points.lines.tolist() == [4, 5]
    assert points.heights is None


def test_columns_may_come_in_any_order_and_case() -> None:
    points = parse('"Y","X",Person,FRAME\n1,2,3,4\n')
    assert points.xy.tolist() == [[2, 1]]
    assert points.frames.tolist() == [4]


def test_identities_and_heights_are_optional() -> None:
    assert parse("frame,x,y\n0,1,2\n").persons is None
    heights = parse("frame,person,x,y,height\n0,1,2,3,1.75\n0,2,2,3,\n").heights
    assert heights is not None
    assert heights[0] == 1.75
    assert np.isnan(heights[1])


def test_windows_line_ends_and_a_byte_order_mark_are_read() -> None:
    assert parse_csv(b"\xef\xbb\xbfframe,x,y\r\n0,1,2\r\n", "a").xy.tolist() == [[1, 2]]


def test_a_file_with_a_header_only_has_nobody() -> None:
    assert parse("frame,person,x,y\n").frames.size == 0


@pytest.mark.parametrize(
    ("header", "reason"),
    [
        ("frame,person,x", "line 1: names no column y"),
        ("1,2,3,4", "line 1: names no column frame, x, y"),
        ("frame,person,x,y,z", "line 1: names unknown columns ['z']"),
        ("frame,x,y,x", "line 1: names a column twice"),
        ("frame;person;x;y", "line 1: names no column frame, x, y"),
    ],
)
def test_a_header_that_is_not_the_format_is_refused(header: str, reason: str) -> None:
    assert problems_of(f"{header}\n")[0] == f"a.csv: {reason}"


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("-1,0,1,2,", "frame is '-1' instead of an integer from 0"),
        ("1.5,0,1,2,", "frame is '1.5' instead of an integer from 0"),
        ("0,x,1,2,", "person is 'x' instead of an integer from 0"),
        ("0,,1,2,", "person is '' instead of an integer from 0"),
        ("0,3000000000,1,2,", "person is '3000000000' instead of an integer from 0"),
        ("0,0,nan,2,", "x is 'nan' instead of a finite number"),
        ("0,0,1,inf,", "y is 'inf' instead of a finite number"),
        ("0,0,1,1e999,", "y is '1e999' instead of a finite number"),
        ("0,0,1_0,2,", "x is '1_0' instead of a finite number"),
        ("0,0,1,2,0", "height is '0' instead of a positive number of metres"),
        ("0,0,1", "3 values instead of 5"),
    ],
)
def test_a_wrong_line_is_told_with_its_number(line: str, reason: str) -> None:
    (problem,) = problems_of(f"frame,person,x,y,height\n0,9,0,0,\n{line}\n")
    assert problem.startswith(f"a.csv: line 3: {reason}")


def test_all_wrong_lines_are_told_at_once() -> None:
    assert len(problems_of("frame,x,y\nx,1,2\n0,x,2\n0,1\n")) == 3


millimetres = st.integers(-(10**7), 10**7).map(lambda value: value / 1000)


@st.composite
def points(draw: st.DrawFn) -> GroundPoints:
    keys = draw(st.lists(st.tuples(st.integers(0, 9999), st.integers(0, 2**31 - 1)), unique=True, max_size=5))
    frames, persons = np.array(keys, dtype=np.int64).reshape(-1, 2).T
    xy = np.array([[draw(millimetres), draw(millimetres)] for _ in keys], dtype=float).reshape(-1, 2)
    heights = np.array([draw(st.sampled_from([1.6, 1.75, np.nan])) for _ in keys], dtype=float)
    return GroundPoints(frames, xy, persons, heights)


@given(points())
def test_what_was_written_comes_back(table: GroundPoints) -> None:
    data = csv_header(heights=True) + csv_lines(table, heights=True)
    again = parse_csv(data, "a.csv")
    assert csv_header(heights=True) + csv_lines(again, heights=True) == data
    for name in ("frames", "xy", "persons", "heights"):
        assert np.array_equal(getattr(again, name), getattr(table, name), equal_nan=name == "heights")


def test_positions_of_the_grid_are_written_without_noise() -> None:
    xy = np.array([[-3.0 + 0.025 * 346, -9.0 + 0.025 * 951]])
    lines = csv_lines(GroundPoints(np.array([5]), xy, np.array([0])))
    assert csv_header() + lines == b"frame,person,x,y\n5,0,5.65,14.775\n"


def test_a_column_that_is_not_there_is_not_invented() -> None:
    with pytest.raises(ValueError, match="lacks a column"):
        csv_lines(GroundPoints(np.array([0]), np.zeros((1, 2))))


WORDS = st.sampled_from(
    ["frame", "person", "x", "y", "height", "1", "-2", "1.5", "nan", '"', "#", "", "\n", "9" * 50]
)


@settings(max_examples=200)
@given(st.binary(max_size=200) | st.lists(WORDS, max_size=40).map(lambda words: ",".join(words).encode()))
def test_any_bytes_are_either_read_or_refused(data: bytes) -> None:
    for head in (b"", b"frame,person,x,y,height\n"):
        try:
            parse_csv(head + data, "a")
        except FormatError as error:
            assert error.problems
