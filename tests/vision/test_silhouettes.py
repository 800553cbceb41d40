"""What the foreground of a view says about where bodies are."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.vision.silhouettes import SilhouetteSettings, silhouettes
from gtm_hit.vision.templates import HALF, ROWS, drawn, fitted, painted, sampled

SHAPE = (270, 480)
SETTINGS = SilhouetteSettings()
ADA = np.array([200.0, 60.0, 230.0, 160.0])


def moved(box: np.ndarray, aside: float, down: float = 0.0) -> np.ndarray:
    return box + np.array([aside, down, aside, down])


BO = moved(ADA, 18, 4)  # half before Ada


def foreground(*boxes: np.ndarray, trust: float = 1.0) -> np.ndarray:
    """As a perfect background sees bodies of the template's shape."""
    seen = 1 - np.exp(painted(drawn(), np.array(boxes).reshape(-1, 4), SHAPE))
    return (0.5 + trust * (np.clip(1.6 * seen, 0.05, 0.95) - 0.5)).astype(np.float32)


def found(mask: np.ndarray, *expected: np.ndarray):
    return silhouettes(mask, 1.0, np.array(expected), np.ones(len(expected)), SETTINGS)


@pytest.mark.parametrize("aside", [-11.0, -4.0, 0.0, 7.5])
def test_a_body_beside_its_expected_place_is_found_there(aside: float) -> None:
    said = found(foreground(ADA), moved(ADA, aside))
    assert said.middle[0] == pytest.approx(215, abs=0.7)
    assert said.spread[0] < 0.02


def test_somebody_half_hidden_is_found_once_the_other_is_explained() -> None:
    mask = foreground(ADA, BO)
    both = found(mask, moved(ADA, 5), BO)
    assert both.middle[0] == pytest.approx(215, abs=1.5)
    assert both.middle[1] == pytest.approx(233, abs=1.5)


def test_foreground_that_others_explain_says_nothing() -> None:
    said = found(foreground(BO), BO, moved(BO, -2, -2))
    assert np.isnan(said.middle[1])


def test_a_background_nobody_trusts_says_nothing() -> None:
    assert np.isnan(found(foreground(ADA, trust=0.0), ADA).middle[0])


def test_where_nobody_is_the_template_does_not_fit() -> None:
    said = found(foreground(ADA), moved(ADA, 100))
    assert np.isnan(said.middle[0]) and said.gain[0] < 0


def windows(count: int, width: float) -> np.ndarray:
    """Of masks that show everybody as wide as this, a share of their height to either side."""
    columns = np.abs(np.arange(2 * HALF) + 0.5 - HALF) / (2 * HALF)
    return np.tile(np.where(columns < width, 0.9, 0.1), (count, ROWS, 1))


def test_a_template_is_fitted_to_people_as_wide_as_they_are() -> None:
    wide, slim = (fitted(windows(80, width), 40, drawn()) for width in (0.3, 0.15))
    assert wide is not None and slim is not None
    assert wide.body.sum() > 1.5 * slim.body.sum()
    assert (wide.people, wide.windows) == (40, 80)
    assert slim.nobody == pytest.approx(0.1)


def test_too_few_people_make_no_template() -> None:
    assert fitted(windows(10, 0.2), 5, drawn()) is None


def test_places_where_nobody_stands_make_no_template() -> None:
    noise = np.random.default_rng(1).random((80, ROWS, 2 * HALF))
    assert fitted(noise, 40, drawn()) is None


def test_a_window_is_read_from_head_to_feet_and_around_the_middle() -> None:
    image = np.zeros(SHAPE, np.float32)
    image[60:110] = 1.0  # Ada's upper half
    (window,) = sampled(image, ADA[None])
    assert window[:9].min() == 1.0 and window[11:].max() == 0.0
