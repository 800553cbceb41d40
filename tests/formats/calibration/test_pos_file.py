from __future__ import annotations

import pytest

from gtm_hit.formats.calibration.pos_file import Numbering, PosPerson, parse_pos
from gtm_hit.formats.problems import FormatError


def parsed(text: str, numbering: Numbering | None = None) -> tuple[list[PosPerson], Numbering]:
    file = parse_pos(text.encode(), "000000.pos", numbering)
    return list(file.people), file.numbering


def problems_of(text: str) -> str:
    with pytest.raises(FormatError) as caught:
        parsed(text)
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "numbering"),
    [("ada\n0 10 20\n1 11 5\n", Numbering.FROM_ZERO), ("ada\n1 10 20\n2 11 5\n", Numbering.FROM_ONE)],
)
def test_both_numberings_are_read_and_told(text: str, numbering: Numbering) -> None:
    assert parsed(text) == ([PosPerson("ada", (10.0, 20.0), (11.0, 5.0))], numbering)


def test_points_may_be_missing_and_blank_lines_are_none() -> None:
    people, _ = parsed("\n\nada\n0 10 20\n\n\n17\n1 1.5 2.5\nbob\n")
    assert people == [
        PosPerson("ada", (10.0, 20.0), None),
        PosPerson("17", None, (1.5, 2.5)),
        PosPerson("bob", None, None),
    ]


def test_points_1_alone_are_asked_about_unless_it_is_said() -> None:
    assert "has points 1 only" in problems_of("ada\n1 10 20\n")
    assert parsed("ada\n1 10 20\n", Numbering.FROM_ONE)[0][0].feet == (10.0, 20.0)
    assert parsed("ada\n1 10 20\n", Numbering.FROM_ZERO)[0][0].head == (10.0, 20.0)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("0 1 2\nada\n", "line 1: a point before any identity"),
        ("ada\n0 1 x\n", "line 2: y is 'x' instead of a finite number"),
        ("ada\n0 1 2\n2 3 4\n", "points 0 and points 2"),
        ("ada\n0 1 2\n0 3 4\n", "line 3: 'ada' has a point 0 already in line 2"),
        ("ada\n0 1 2\n5 3 4\n", "line 3: point 5 is none of"),
        ("ada\n0 1 2\nada\n1 3 4\n", "'ada' is there 2 times"),
    ],
)
def test_what_is_wrong_is_told(text: str, told: str) -> None:
    assert told in problems_of(text)
