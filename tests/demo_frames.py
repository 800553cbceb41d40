"""The demo scene's first frames, looked at by the built-in detector, once for all tests of a process."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import pytest

from benchmarks.proposal_scenes import ROOT, Example, demo
from gtm_hit.vision import detectors
from gtm_hit.vision.background import Backgrounds
from gtm_hit.vision.boxes import Box
from gtm_hit.vision.people import FrameProposals
from gtm_hit.vision.proposing import Method, Proposer, Settings

GROUP = "demo frames"  # of pytest-xdist: one process renders them


@dataclass(frozen=True)
class LookedAt:
    """What was found in each frame, and the boxes it was found from."""

    example: Example
    model: str
    boxes: list[dict[str, list[Box]]]
    found: list[FrameProposals]


def detector_or_skip() -> detectors.NanoDet:
    for folder in (Path(os.environ["DATA_DIR"]), ROOT / "var"):
        if found := detectors.built_in(folder):
            return found
    pytest.skip("the person detector is not there: `make detector` fetches it")


def look(folder: Path) -> LookedAt:
    """By the default method with its default settings."""
    detector = detector_or_skip()
    example = demo(folder)
    backgrounds = Backgrounds.learn(example.frames, example.scene.cameras)
    proposer = Proposer(example.scene, Method.COVER, detector, Settings(), backgrounds)
    boxes, found = [], []
    for pictures in example.frames:
        boxes.append(proposer.boxes(pictures))
        found.append(proposer.frame(pictures, boxes[-1]))
    return LookedAt(example, detector.version, boxes, found)
