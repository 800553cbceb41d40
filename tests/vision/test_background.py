"""The background is what most frames show, and says where they do not agree."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.vision.background import Backgrounds
from tests.vision.plaza import CAMERAS, pictures

ONE = {"C1": CAMERAS["C1"]}
STAYS = (0.0, 0.0, 1.72)


def frames(count: int, *people: tuple[float, float, float]) -> list[dict[str, np.ndarray]]:
    return [{"C1": pictures(people, seed)["C1"]} for seed in range(count)]


@pytest.mark.parametrize("count", [5, 6, 8, 13])
def test_the_background_is_what_the_middle_one_of_the_frames_shows(count: int) -> None:
    rng = np.random.default_rng(count)
    shots = [{"C1": rng.integers(0, 256, (540, 960, 3)).astype(np.uint8)} for _ in range(count)]
    learned = Backgrounds.learn(shots, ONE).cameras["C1"]
    stack = np.stack([each["C1"] for each in shots])[:, :40].astype(np.float32)
    np.testing.assert_array_equal(learned.usual[:40], np.sort(stack, axis=0)[(count - 1) // 2])


def test_four_frames_are_too_few() -> None:
    assert Backgrounds.learn(frames(4), ONE).cameras == {}


def test_where_somebody_stands_in_half_of_the_frames_nothing_is_trusted() -> None:
    shots = [*frames(5), *frames(5, STAYS)]
    learned = Backgrounds.learn(shots, ONE).cameras["C1"]
    mask = learned.foreground(shots[-1]["C1"])
    assert learned.trust.min() == 0.0
    assert np.all(mask[learned.trust == 0.0] == 0.5)


def test_a_brighter_picture_is_still_the_background() -> None:
    shots = frames(6)
    learned = Backgrounds.learn(shots, ONE).cameras["C1"]
    brighter = np.clip(shots[0]["C1"] * 1.15, 0, 255).astype(np.uint8)
    assert learned.foreground(brighter).mean() < 0.1
