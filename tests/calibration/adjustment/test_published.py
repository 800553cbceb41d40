"""WILDTRACK's own problem, whose result was published."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gtm_hit.calibration.adjustment.adjusting import adjust
from gtm_hit.calibration.adjustment.problem import problem_of
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.formats.calibration.ba_problem import read_ba_problem
from tests.calibration.adjustment.scene import true_cameras


def test_two_passes_end_where_the_published_cameras_are(shared_data: Path) -> None:
    path = shared_data / "calibration" / "wildtrack_ba" / "ba_problem.txt"
    result = adjust(problem_of(read_ba_problem(path), (1920, 1080)), Variant.TWO_PASS)
    assert result.cost.total <= 17_705
    for view, camera in zip(result.views, true_cameras(7), strict=True):
        assert np.linalg.norm(view.camera().centre - camera.centre) < 0.01
