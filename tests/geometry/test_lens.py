from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.geometry import lens
from tests.geometry.scenes import wildtrack_cameras
from tests.geometry.test_camera import FULL_LENS

LENSES = [camera.distortion for camera in wildtrack_cameras(original=True)]


@given(st.sampled_from([*LENSES, FULL_LENS]), st.floats(0, 0.7), st.floats(0, 2 * np.pi))
def test_undistorting_is_the_inverse_of_distorting(
    distortion: np.ndarray, radius: float, angle: float
) -> None:
    x, y = np.array([radius * np.cos(angle)]), np.array([radius * np.sin(angle)])
    tilt = lens.tilt_matrix(distortion)
    back = lens.undistort(*lens.distort(x, y, distortion, tilt), distortion, tilt)
    np.testing.assert_allclose(back, (x, y), atol=1e-9)


def test_a_lens_that_folds_back_has_a_limit_where_it_turns() -> None:
    # r·(1 - 0.3 r²) turns at r = 1/√0.9
    assert lens.limit(np.array([-0.3, 0, 0, 0])) == pytest.approx(1 / np.sqrt(0.9), abs=2e-3)


def test_a_lens_that_never_folds_back_has_no_limit() -> None:
    assert lens.limit(np.array([0.1, 0.01, 0, 0])) == np.inf


def test_beyond_the_limit_there_is_no_inverse() -> None:
    distortion = np.array([-0.3, 0.0, 0.0, 0.0])
    assert np.isnan(lens.undistort(np.array([0.9]), np.array([0.0]), distortion)).all()
