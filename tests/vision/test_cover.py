"""Boxes of several views become people, each box for one of them."""

from __future__ import annotations

import numpy as np

from gtm_hit.vision.cover import Body, CoverSettings, Places, cover
from gtm_hit.vision.disagreement import agreements, alarm, suspect
from tests.vision.plaza import CAMERAS, GRID, all_boxes, camera

SETTINGS = CoverSettings()
PLACES = Places(CAMERAS, GRID, SETTINGS)
STANDING = [(0.0, 0.0, 1.72), (1.5, 0.8, 1.8), (-1.2, 1.6, 1.65), (0.6, -1.9, 1.75)]


def nearest(bodies: list[Body], person: tuple[float, float, float]) -> Body:
    return min(bodies, key=lambda body: float(np.hypot(*(body.xy - person[:2]))))


def test_everybody_is_found_once_and_within_centimetres() -> None:
    bodies = cover(all_boxes(STANDING), CAMERAS, PLACES, SETTINGS)
    assert len(bodies) == len(STANDING)
    for person in STANDING:
        assert np.hypot(*(nearest(bodies, person).xy - person[:2])) < 0.05


def test_no_box_counts_for_two_people() -> None:
    bodies = cover(all_boxes([*STANDING, (0.45, 0.1, 1.7)]), CAMERAS, PLACES, SETTINGS)
    used = [pair for body in bodies for pair in body.boxes.items()]
    assert len(used) == len(set(used))


def test_without_boxes_nobody_is_found() -> None:
    assert cover({name: [] for name in CAMERAS}, CAMERAS, PLACES, SETTINGS) == []


def test_somebody_who_sits_is_found_at_their_own_height() -> None:
    bodies = cover(all_boxes([*STANDING, (-2.0, -1.0, 0.9)]), CAMERAS, PLACES, SETTINGS)
    sitting = nearest(bodies, (-2.0, -1.0, 0.9))
    assert sitting.height < SETTINGS.sitting
    assert np.hypot(*(sitting.xy - (-2.0, -1.0))) < 0.1


def test_a_camera_that_was_turned_is_named_and_the_others_are_not() -> None:
    boxes = all_boxes(STANDING)
    turned = {**CAMERAS, "C3": camera(2, 200, turned=8)}
    places = Places(turned, GRID, SETTINGS)
    bodies = cover(boxes, turned, places, SETTINGS)
    assert suspect(agreements(bodies, boxes, turned)) == "C3"
    fewer = {name: found for name, found in boxes.items() if name != "C3"}
    said = alarm("C3", cover(fewer, turned, places, SETTINGS), boxes, turned)
    assert said is not None and said.metres > 0.5 and "C3" in said.why


def test_cameras_that_agree_are_not_suspected() -> None:
    boxes = all_boxes(STANDING)
    bodies = cover(boxes, CAMERAS, PLACES, SETTINGS)
    assert suspect(agreements(bodies, boxes, CAMERAS)) is None
