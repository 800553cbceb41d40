"""The door: pictures in, proposals with evidence out, with a detector and without."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gtm_hit.vision.background import Backgrounds
from gtm_hit.vision.boxes import Box, Picture
from gtm_hit.vision.people import as_json
from gtm_hit.vision.proposing import Method, Proposer, Scene, Settings, propose, usable_method
from tests.vision.plaza import CAMERAS, GRID, all_boxes, pictures

SCENE = Scene(CAMERAS, GRID)
WALK = [[(-1.5 + 0.5 * i, 0.3, 1.72), (1.2, 1.6 - 0.5 * i, 1.75)] for i in range(9)]


class Known:
    """A detector that knows the boxes of one frame's pictures."""

    version = "known"

    def __init__(self, people: list[tuple[float, float, float]]) -> None:
        self.left = list(all_boxes(people).values())

    def detect(self, image: Picture) -> list[Box]:
        return self.left.pop(0)


def test_a_proposal_says_in_each_view_why_it_is_believed() -> None:
    frame = Proposer(SCENE, Method.COVER, Known(WALK[2]), Settings()).frame(pictures(WALK[2]))
    assert len(frame.people) == 2
    for person in frame.people:
        assert {each.camera for each in person.evidence} == set(CAMERAS)
        assert person.views >= 3 and person.score > 0.8
        assert all(math.isnan(each.seen) for each in person.evidence)
    assert frame.suspicious == ()


def test_the_background_says_what_it_saw() -> None:
    backgrounds = Backgrounds.learn([pictures(each, seed) for seed, each in enumerate(WALK)], CAMERAS)
    proposer = Proposer(SCENE, Method.COVER, Known(WALK[2]), Settings(), backgrounds)
    frame = proposer.frame(pictures(WALK[2]))
    assert min(max(each.seen for each in person.evidence) for person in frame.people) > 0.6


def test_boxes_that_were_kept_give_the_same_people() -> None:
    detector = Known(WALK[1])
    proposer = Proposer(SCENE, Method.COVER, detector, Settings())
    boxes = proposer.boxes(pictures(WALK[1]))
    first, again = (proposer.frame(pictures(WALK[1]), boxes) for _ in range(2))
    assert [as_json(each) for each in first.people] == [as_json(each) for each in again.people]
    assert detector.left == []


@pytest.mark.parametrize("method", ["cover", "pom"])
def test_without_a_detector_the_background_finds_them(method: str) -> None:
    found = propose([pictures(each, seed) for seed, each in enumerate(WALK)], CAMERAS, GRID, method=method)
    assert [len(frame.people) for frame in found] == [2] * len(WALK)
    for frame, people in zip(found, WALK, strict=True):
        truth = np.array([person[:2] for person in people])
        places = np.array([(each.x, each.y) for each in frame.people])
        assert np.hypot(*(truth[:, None] - places[None]).transpose(2, 0, 1)).min(axis=1).max() < 0.35


def test_cover_without_a_detector_is_the_background() -> None:
    assert usable_method("cover", None) is Method.BACKGROUND


def test_feet_projected_and_clustered_find_who_is_seen_whole() -> None:
    frame = Proposer(SCENE, Method.PROJECTED, Known(WALK[2]), Settings()).frame(pictures(WALK[2]))
    assert len(frame.people) == 2
