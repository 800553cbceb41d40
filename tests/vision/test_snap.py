"""A rough click is put right, and left alone where it should be."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.vision.background import Backgrounds
from gtm_hit.vision.snap import Marks, Refused, snap, with_unmarked
from tests.vision.plaza import CAMERAS, all_boxes, pictures

ADA, BO = (-1.0, 0.3, 1.72), (0.4, -0.8, 1.72)
NOBODY = np.zeros((0, 3))


def marks(click: tuple[float, float], *others: tuple[float, float, float]) -> Marks:
    return Marks(np.array([*click, 1.72]), np.array(others).reshape(-1, 3))


def off(x: float, y: float, person: tuple[float, float, float]) -> float:
    return float(np.hypot(x - person[0], y - person[1]))


@pytest.mark.parametrize("degrees", [10, 130, 250])
def test_a_click_finds_the_feet(degrees: float) -> None:
    angle = np.radians(degrees)
    click = (ADA[0] + 0.38 * np.cos(angle), ADA[1] + 0.38 * np.sin(angle))
    found = snap(marks(click, BO), all_boxes([ADA, BO]), CAMERAS)
    assert found.refused is None and found.gain > 1
    assert off(found.x, found.y, ADA) < 0.03


def test_boxes_of_those_who_are_marked_do_not_pull() -> None:
    near = (ADA[0] + 0.7, ADA[1], 1.72)
    click = (ADA[0] + 0.3, ADA[1])
    found = snap(marks(click, near), all_boxes([ADA, near]), CAMERAS)
    assert off(found.x, found.y, ADA) < 0.05


def test_whoever_stands_right_stays() -> None:
    found = snap(marks((ADA[0] + 0.01, ADA[1]), BO), all_boxes([ADA, BO]), CAMERAS)
    assert found.refused is Refused.SMALL
    assert (found.x, found.y) == (ADA[0] + 0.01, ADA[1])


def test_nobody_is_moved_onto_somebody_else() -> None:
    click = (ADA[0] + 0.3, ADA[1])
    found = snap(marks(click, ADA), all_boxes([ADA]), CAMERAS)
    assert found.refused is not None
    assert (found.x, found.y) == click


def test_where_no_view_shows_anybody_nothing_moves() -> None:
    assert snap(marks((2.0, 2.0)), all_boxes([ADA]), CAMERAS).refused is Refused.NOTHING
    assert snap(marks((2.0, 2.0)), {}, CAMERAS).refused is Refused.NOTHING


def test_nobody_is_moved_by_more_than_half_a_metre() -> None:
    found = snap(marks((ADA[0] + 0.53, ADA[1])), all_boxes([ADA]), CAMERAS)
    assert off(found.x, found.y, (ADA[0] + 0.53, ADA[1], 0)) <= 0.5 + 1e-9


def test_the_background_corrects_boxes_that_are_all_off_to_one_side() -> None:
    walk = [[(-2.0 + 0.8 * i, 0.3, 1.72)] for i in range(6)]
    backgrounds = Backgrounds.learn([pictures(each, seed) for seed, each in enumerate(walk)], CAMERAS)
    person = walk[2][0]
    shown = pictures([person])
    masks = {name: each.foreground(shown[name]) for name, each in backgrounds.cameras.items()}
    shifted = {
        name: [box._replace(x1=box.x1 + 8, x2=box.x2 + 8) for box in boxes]
        for name, boxes in all_boxes([person]).items()
    }
    shifted.pop("C2")
    click = marks((person[0] + 0.3, person[1]))
    plain, refined = snap(click, shifted, CAMERAS), snap(click, shifted, CAMERAS, masks)
    assert off(refined.x, refined.y, person) < off(plain.x, plain.y, person)


def test_somebody_proposed_explains_their_boxes_before_they_are_marked() -> None:
    here, beside, far = ((0.5 + off, 0.25, 1.72) for off in (0.0, 0.6, 2.0))
    click = (0.4, 0.25)
    everybody = np.array([here, beside, far])
    assert with_unmarked(marks(click), everybody).others.tolist() == [list(beside), list(far)]
    assert with_unmarked(marks(click, far), everybody).others.tolist() == [list(far), list(beside)]
    assert with_unmarked(marks(click, far), NOBODY).others.tolist() == [list(far)]
