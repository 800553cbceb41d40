"""The table of calibration's bars: every part that it names is there and can be measured."""

from __future__ import annotations

import importlib

import pytest

from benchmarks import calibration, calibration_check, calibration_export


@pytest.mark.parametrize("part", calibration.PARTS)
def test_every_part_of_the_table_can_be_measured(part: str) -> None:
    assert callable(importlib.import_module(f"benchmarks.calibration_{part}").rows)


def test_python_and_the_browser_agree_and_what_is_exported_reads_the_same() -> None:
    rows = [*calibration_check.rows(None), *calibration_export.rows(None)]
    exact = [row for row in rows if "median" not in row.what]  # how long it takes is not tested
    assert [row.what for row in exact if row.met is False] == []
    assert sum(row.met is True for row in exact) == 6
