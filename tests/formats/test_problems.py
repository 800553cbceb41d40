from __future__ import annotations

from pathlib import Path

import pytest

from gtm_hit.formats.problems import MOST_PROBLEMS, FormatError, Problem, ProblemList, shown


def test_a_problem_reads_file_place_reason() -> None:
    assert (
        str(Problem("a.json", "person 3", "position is missing")) == "a.json: person 3: position is missing"
    )


def test_a_problem_without_a_place_leaves_it_out() -> None:
    assert str(Problem("a.json", "", "the file is empty")) == "a.json: the file is empty"


def test_an_error_says_all_its_problems() -> None:
    error = FormatError([Problem("a", "1", "x"), Problem("b", "2", "y")])
    assert str(error) == "a: 1: x\nb: 2: y"
    assert len(error.problems) == 2


def test_paths_can_be_told_relative_to_a_folder() -> None:
    error = FormatError([Problem("/srv/data/set/C1/1.png", "", "x"), Problem("/elsewhere/a", "", "y")])
    assert [problem.path for problem in error.relative_to(Path("/srv/data/set")).problems] == [
        "C1/1.png",
        "/elsewhere/a",
    ]


def test_a_list_without_problems_raises_nothing() -> None:
    ProblemList("a").raise_if_any()


def test_a_list_gives_up_when_there_are_too_many() -> None:
    problems = ProblemList("a")
    with pytest.raises(FormatError, match="the rest is not listed"):
        for line in range(MOST_PROBLEMS + 1):
            problems.add(f"line {line}", "wrong")
    assert len(problems.found) == MOST_PROBLEMS + 1


@pytest.mark.parametrize("value", ["x" * 1000, 10**300, "\ud800\n\x00", {"a": ["b"] * 99}, b"\xff" * 500])
def test_a_value_is_shown_short_on_one_plain_line(value: object) -> None:
    text = shown(value)
    assert len(text) < 120
    assert text.isascii() and text.isprintable()


def test_signs_a_terminal_obeys_are_written_out() -> None:
    problem = Problem("a\x1b[2J.zip", "b\nc", "d\x07 – größer\ud800")
    assert str(problem) == r"a\x1b[2J.zip: b\nc: d\x07 – größer\ud800"
