"""The 150 measured points of WILDTRACK."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.calibration_ground import published, rows
from gtm_hit.calibration.pair_files import read_pairs


@pytest.fixture
def calibration_data(shared_data: Path) -> Path:
    if not (shared_data / "calibration" / "wildtrack_ba").is_dir():
        pytest.skip("reference data not present: calibration/wildtrack_ba")
    return shared_data / "calibration"


def test_every_bar_is_met_but_time_which_is_measured_elsewhere(calibration_data: Path) -> None:
    told = [row for row in rows(calibration_data) if "published" in row.what and "slowest" not in row.what]
    assert len(told) == 6
    assert [row for row in told if not row.met] == []


def test_the_typing_error_in_the_second_camera_is_doubted_by_name(calibration_data: Path) -> None:
    (told,) = read_pairs(calibration_data / "wildtrack_ba" / "ground_points_C2.json").doubts
    assert told == "X of point 26 is 519 cm, 1 cm off the 6 others at 518 cm."


def test_all_pairs_are_read(calibration_data: Path) -> None:
    assert sum(len(each.pairs) for each in published(calibration_data / "wildtrack_ba")) == 150
