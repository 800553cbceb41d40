from __future__ import annotations

import numpy as np

from gtm_hit.calibration.ghosts import expected_pixels
from gtm_hit.calibration.ground_points import GroundPoint
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.pose import solve_pose
from gtm_hit.geometry.camera import project
from tests.calibration.clicked import GRID, LENS, clicks, exact, standing

CAMERA = standing()


def test_after_four_pairs_all_other_points_are_expected_within_three_sigma() -> None:
    pairs = clicks(CAMERA, noise=0.7)
    few = [pairs[0], pairs[4], pairs[20], pairs[24]]
    ghosts = expected_pixels(solve_pose(LENS, few), GRID)
    true = project(CAMERA, [point.place for point in GRID])
    off = np.hypot(*(np.array([(ghost.x, ghost.y) for ghost in ghosts]) - true).T)
    assert all(ghost.visible for ghost in ghosts)
    assert (off < [4 * ghost.sigma + 1e-9 for ghost in ghosts]).all()
    assert max(ghost.sigma for ghost in ghosts) < 20


def test_points_behind_the_camera_or_beside_the_picture_are_not_visible() -> None:
    ghosts = expected_pixels(
        exact(CAMERA), [GroundPoint("behind", 0.0, -30.0), GroundPoint("beside", 60.0, 8.0), GRID[12]]
    )
    assert [ghost.visible for ghost in ghosts] == [False, False, True]


def test_a_point_that_the_lens_folds_back_into_the_picture_is_not_visible() -> None:
    folding = Lens(1920, 1080, LENS.matrix, np.array([-0.9, 0.0, 0.0, 0.0, 0.0]))
    camera = standing(folding)
    far = GroundPoint("far beside", 10.0, 3.0)
    (pixel,) = project(camera, [far.place])
    assert (pixel > 0).all() and (pixel < [1920, 1080]).all()
    assert not expected_pixels(exact(camera, folding), [far])[0].visible


def test_no_points_have_no_ghosts() -> None:
    assert expected_pixels(exact(CAMERA), []) == []
