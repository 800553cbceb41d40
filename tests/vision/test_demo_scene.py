"""The gate: how good proposals are, on pictures that the project renders itself."""

from __future__ import annotations

import pytest

from benchmarks.proposal_scores import linked, per_frame
from tests.demo_frames import GROUP, LookedAt

pytestmark = pytest.mark.xdist_group(GROUP)


def test_nine_of_ten_people_of_the_demo_scene_are_proposed_and_few_others(demo_frames: LookedAt) -> None:
    score = per_frame(demo_frames.example, demo_frames.found)
    assert score.frames == 10
    assert 100 * score.moda >= 83


def test_linking_finds_more_of_them_and_knows_who_is_who(demo_frames: LookedAt) -> None:
    score = linked(demo_frames.example, demo_frames.found)
    assert 100 * score.detection.moda >= 87
    assert 100 * score.tracking.idf1 >= 93
