from __future__ import annotations

import pytest

from gtm_hit.ops.files.csv_text import csv_text


@pytest.mark.parametrize("word", ["=1+1", "+1", "-1", "@sum", "\tx", "\rx"])
def test_no_cell_begins_as_a_formula(word: str) -> None:
    assert csv_text(["note"], [[word]]).splitlines()[1].lstrip('"').startswith("'")


def test_numbers_stay_numbers() -> None:
    assert csv_text(["metres"], [[-1.5]]) == "metres\n-1.5\n"


def test_a_table_without_names_has_no_first_line() -> None:
    assert csv_text([], []) == ""
