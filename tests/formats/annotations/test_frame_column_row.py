from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.formats.annotations import frame_column_row
from gtm_hit.formats.annotations.frame_column_row import MOST, FrameColumnRow
from gtm_hit.formats.problems import FormatError


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "lines.txt"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def refused(path: Path, **options: bool) -> list[tuple[str, str]]:
    with pytest.raises(FormatError) as caught:
        frame_column_row.read(path, **options)
    assert {problem.path for problem in caught.value.problems} == {str(path)}
    return [(problem.place, problem.reason) for problem in caught.value.problems]


def test_each_line_is_one_person(tmp_path: Path) -> None:
    lines = frame_column_row.read(written(tmp_path, "0 346 951\n5 2 479\n"))
    assert lines.frames.tolist() == [0, 5]
    assert lines.columns.tolist() == [346, 2]
    assert lines.rows.tolist() == [951, 479]
    assert lines.persons is None


@pytest.mark.parametrize(
    "text",
    [
        "0 1 2",
        "\ufeff0 1 2\n",
        "# frame column row\n\n  0\t1  2 # first\r\n",
        "0.000000000000000000e+00 1.000000000000000000e+00 2.000000000000000000e+00\n",
        "0.0 1. 2.00\n",
    ],
)
def test_numbers_may_be_written_as_numpy_and_people_write_them(tmp_path: Path, text: str) -> None:
    lines = frame_column_row.read(written(tmp_path, text))
    assert (lines.frames.tolist(), lines.columns.tolist(), lines.rows.tolist()) == ([0], [1], [2])


def test_every_wrong_line_is_named(tmp_path: Path) -> None:
    path = written(tmp_path, "0 1 2\n0 1\nx 2 3\n\n0 2.5 3\n1 2 3 4\n0 -1 nan\n0 9999999999 1\n")
    assert [place for place, _ in refused(path)] == [
        *("line 2", "line 3", "line 5", "line 6", "line 7", "line 7", "line 8")
    ]


def test_a_problem_says_what_was_expected(tmp_path: Path) -> None:
    assert refused(written(tmp_path, "0 one 2\n3 4\n")) == [
        ("line 1", f"column is not a whole number from 0 to {MOST}: 'one'"),
        ("line 2", "2 values instead of 3 (frame column row)"),
    ]


def test_persons_are_the_fourth_value(tmp_path: Path) -> None:
    lines = frame_column_row.read(written(tmp_path, "0 1 2 7\n0 3 4 8\n"), persons=True)
    assert lines.persons is not None
    assert lines.persons.tolist() == [7, 8]


def test_a_fourth_value_on_all_lines_is_ignored_when_nobody_asked_for_persons(tmp_path: Path) -> None:
    lines = frame_column_row.read(written(tmp_path, "0 1 2 7\n0 3 4 8\n"))
    assert (lines.rows.tolist(), lines.persons) == ([2, 4], None)


def test_a_file_without_persons_is_one_problem_when_persons_are_asked_for(tmp_path: Path) -> None:
    path = written(tmp_path, "0 1 2\n" * 50)
    assert refused(path, persons=True) == [("", "no line has a person, the fourth value")]


def test_a_person_twice_in_a_frame_is_named_with_both_lines(tmp_path: Path) -> None:
    path = written(tmp_path, "0 1 2 7\n5 1 2 7\n0 3 4 7\n")
    assert refused(path, persons=True) == [("line 3", "person 7 is already in frame 0 on line 1")]


def test_two_people_may_share_a_position(tmp_path: Path) -> None:
    assert len(frame_column_row.read(written(tmp_path, "0 1 2\n0 1 2\n")).frames) == 2


@pytest.mark.parametrize("text", ["", "\n", "# nobody\n"])
def test_only_detections_may_be_empty(tmp_path: Path, text: str) -> None:
    path = written(tmp_path, text)
    assert len(frame_column_row.read(path, may_be_empty=True).frames) == 0
    assert refused(path)[0][0] == ""


def test_a_missing_file_is_a_problem_even_where_an_empty_one_is_not(tmp_path: Path) -> None:
    assert refused(tmp_path / "none.txt", may_be_empty=True) == [("", "no such file")]


whole = st.integers(0, MOST)


@given(st.lists(st.tuples(whole, whole, whole), min_size=1))
def test_what_was_written_is_read_again(tmp_path_factory, values) -> None:
    columns = np.array(values, dtype=np.int64).T
    data = frame_column_row.lines(FrameColumnRow(*columns))
    again = frame_column_row.read(written(tmp_path_factory.mktemp("lines"), data))
    assert np.array_equal([again.frames, again.columns, again.rows], columns)


@given(st.binary(), st.booleans())
def test_any_bytes_are_read_or_refused(tmp_path_factory, data: bytes, persons: bool) -> None:
    path = written(tmp_path_factory.mktemp("bytes"), data)
    try:
        lines = frame_column_row.read(path, persons=persons)
    except FormatError as error:
        assert error.problems
    else:
        assert len(lines.frames) == len(lines.columns) == len(lines.rows)


def test_the_published_ground_truth_is_read_whole(shared_data: Path) -> None:
    lines = frame_column_row.read(shared_data / "wildtrack" / "positions_0000-0995.txt")
    assert len(lines.frames) == 4785
    assert len(np.unique(lines.frames)) == 200
    assert lines.columns.max() < 480 and lines.rows.max() < 1440
