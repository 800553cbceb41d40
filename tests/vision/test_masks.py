"""Foregrounds are kept small, and come back as they were to a step of grey."""

from __future__ import annotations

import numpy as np
import pytest

from gtm_hit.vision.background import Backgrounds
from gtm_hit.vision.masks import STEPS, Notes, packed, unpacked
from tests.vision.plaza import CAMERAS, pictures


def test_masks_come_back_to_a_step_of_grey_and_what_is_unknown_stays_unknown() -> None:
    rng = np.random.default_rng(1)
    masks = {name: rng.random((54, 96), dtype=np.float32) for name in ("file", "a/b")}
    masks["unknown"] = np.full((54, 96), 0.5, np.float32)
    back = unpacked(packed(masks))
    assert list(back) == list(masks)
    assert all(np.abs(back[name] - masks[name]).max() <= 0.5 / STEPS + 1e-6 for name in masks)
    assert (back["unknown"] == 0.5).all()


@pytest.mark.parametrize("data", [b"", b"PK nothing", packed({})[:40]])
def test_what_is_no_archive_of_masks_is_refused(data: bytes) -> None:
    with pytest.raises(ValueError, match="no masks"):
        unpacked(data)


def test_the_foregrounds_seen_while_looking_are_noted_once() -> None:
    walk = [pictures([(-2.0 + 0.8 * i, 0.3, 1.72)], i) for i in range(6)]
    notes = Notes(Backgrounds.learn(walk, CAMERAS))
    assert notes.take() == {}
    seen = {name: each.foreground(walk[2][name]) for name, each in notes.backgrounds.cameras.items()}
    taken = notes.take()
    assert taken.keys() == seen.keys() and all(taken[name] is seen[name] for name in seen)
    assert notes.take() == {}
