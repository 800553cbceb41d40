from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from gtm_hit.geometry.camera import (
    CalibrationError,
    Camera,
    CameraModel,
    beyond_fold,
    normalise,
    undistort_maps,
    undistorted,
)
from gtm_hit.geometry.undistorting import kept_matrix, without_picture
from tests.geometry.scenes import wildtrack_cameras

CAMERAS = wildtrack_cameras(original=True)
FISHEYE = Camera(
    0,
    "round",
    640,
    480,
    [[300.0, 0, 320], [0, 300, 240], [0, 0, 1]],
    [0, 0, 0],
    [0, 0, 0],
    [0.02, -0.01, 0.002, 0.0],
    CameraModel.FISHEYE,
)


def ids(camera: Camera) -> str:
    return camera.name


@pytest.mark.parametrize("camera", [*CAMERAS, FISHEYE], ids=ids)
def test_alpha_0_leaves_no_pixel_without_picture(camera: Camera) -> None:
    assert without_picture(camera, kept_matrix(camera, 0.0)).sum() == 0


@pytest.mark.parametrize("camera", CAMERAS, ids=ids)
def test_alpha_1_loses_nothing_that_the_lens_has_an_answer_for(camera: Camera) -> None:
    ideal = undistorted(camera, kept_matrix(camera, 1.0))
    rim = [(x, y) for x in range(0, 1920, 40) for y in (0, 1079)]
    rim += [(x, y) for x in (0, 1919) for y in range(0, 1080, 40)]
    directions = normalise(camera, rim)
    known = directions[np.isfinite(directions).all(axis=1)]
    pixels = known @ ideal.matrix[:2, :2].T + ideal.matrix[:2, 2]
    assert len(known) > 0.9 * len(rim)
    assert (pixels >= -0.5).all() and (pixels <= [1919.5, 1079.5]).all()


def test_between_the_two_ends_more_is_kept_the_larger_alpha_is() -> None:
    black = [without_picture(CAMERAS[0], kept_matrix(CAMERAS[0], alpha)).sum() for alpha in (0, 0.3, 0.6, 1)]
    assert black == sorted(black) and len(set(black)) == 4


@pytest.mark.parametrize("alpha", [-0.1, 1.1, float("nan")])
def test_another_alpha_is_refused(alpha: float) -> None:
    with pytest.raises(CalibrationError, match="from 0 to 1"):
        kept_matrix(CAMERAS[0], alpha)


def test_pixels_beyond_the_fold_are_black_and_others_are_not() -> None:
    folding = replace(CAMERAS[0], distortion=np.array([-0.6, 0.0, 0.0, 0.0, 0.0]))
    wide = folding.matrix * [[0.4], [0.4], [1]] + [[0, 0, 500], [0, 0, 300], [0, 0, 0]]
    white = np.full((1080, 1920), 255, np.uint8)
    shown = cv2.remap(white, *undistort_maps(folding, wide), cv2.INTER_LINEAR)
    folded = beyond_fold(folding, wide)
    assert 0.05 < folded.mean() < 0.95
    assert shown[folded].max() == 0
    naive = cv2.initUndistortRectifyMap(
        folding.matrix, folding.distortion, None, wide, (1920, 1080), cv2.CV_16SC2
    )
    assert cv2.remap(white, *naive, cv2.INTER_LINEAR)[folded].max() == 255  # what OpenCV repeats there
    kept = ~without_picture(folding, wide)
    assert (shown[cv2.erode(kept.astype(np.uint8), np.ones((5, 5))) > 0] == 255).all()
