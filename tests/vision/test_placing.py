"""Bodies are put where the foreground shows them, each with the others explained."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.geometry.camera import Camera
from gtm_hit.vision.cover import Body
from gtm_hit.vision.outlines import Shown
from gtm_hit.vision.placing import PlacingSettings, placed
from tests.vision.plaza import CAMERAS

ADA, BO = np.array([0.2, 0.4, 1.72]), np.array([0.7, 0.7, 1.72])


def moved(place: np.ndarray, x: float, y: float = 0.0) -> np.ndarray:
    return place + np.array([x, y, 0.0])


def seen(camera: Camera, *people: np.ndarray, trust: float = 1.0) -> np.ndarray:
    """A mask as a perfect background makes it of people of the outline's shape."""
    shape = (camera.height // 2, camera.width // 2)
    nothing = Shown(np.zeros(shape, np.float32), camera, np.array(people))
    shown = nothing.explained((0, 0, shape[1], shape[0]))
    return (0.5 + trust * (shown - 0.5)).astype(np.float32)


def body(place: np.ndarray, spread: float = 0.05) -> Body:
    return Body(place[:2], float(place[2]), 1.0, {}, np.eye(2) * spread**2)


def put(masks: dict[str, np.ndarray], *bodies: Body) -> np.ndarray:
    return np.array([each.xy for each in placed(bodies, masks, CAMERAS, PlacingSettings())])


@pytest.mark.parametrize("off", [(0.12, 0.0), (-0.1, 0.1), (0.0, -0.15), (0.0, 0.0)])
def test_a_body_is_put_where_it_is_seen(off: tuple[float, float]) -> None:
    masks = {name: seen(camera, ADA) for name, camera in CAMERAS.items()}
    found = put(masks, body(moved(ADA, *off)))
    assert np.hypot(*(found[0] - ADA[:2])) < 0.03


def test_two_who_hide_each_other_are_both_put_right() -> None:
    masks = {name: seen(camera, ADA, BO) for name, camera in CAMERAS.items()}
    found = put(masks, body(moved(ADA, 0.08, 0.05)), body(moved(BO, -0.08)))
    assert np.hypot(*(found - [ADA[:2], BO[:2]]).T).max() < 0.04


def test_who_is_found_does_not_depend_on_the_order() -> None:
    masks = {name: seen(camera, ADA, BO) for name, camera in CAMERAS.items()}
    one, other = body(moved(ADA, 0.08, 0.05)), body(moved(BO, -0.08))
    np.testing.assert_array_equal(put(masks, one, other), put(masks, other, one)[::-1])


def test_where_nothing_is_known_everybody_stays() -> None:
    masks = {name: seen(camera, ADA, trust=0.0) for name, camera in CAMERAS.items()}
    start = moved(ADA, 0.1)
    np.testing.assert_array_equal(put(masks, body(start)), [start[:2]])


def test_boxes_that_are_sure_hold_a_body() -> None:
    masks = {name: seen(camera, ADA) for name, camera in CAMERAS.items()}
    start = moved(ADA, 0.12)
    held = put(masks, body(start, spread=0.002))
    assert np.hypot(*(held[0] - start[:2])) < 0.03


def test_nobody_is_nobody() -> None:
    masks = {name: seen(camera, ADA) for name, camera in CAMERAS.items()}
    assert placed([], masks, CAMERAS, PlacingSettings()) == []


def test_foreground_that_others_explain_speaks_for_nobody_else() -> None:
    name, camera = next(iter(CAMERAS.items()))
    mask = seen(camera, ADA)
    alone, beside = Shown(mask, camera, np.zeros((0, 3))), Shown(mask, camera, ADA[None])
    assert alone.agreement(ADA[None])[0] > 100, name
    assert beside.agreement(ADA[None])[0] == 0
    assert beside.agreement(ADA[None], without=0)[0] == pytest.approx(alone.agreement(ADA[None])[0])
