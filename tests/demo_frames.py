"""The demo scene's first frames, looked at by the built-in detector, once for all processes of a test run."""

from __future__ import annotations

import fcntl
import os
import pickle
from dataclasses import dataclass
from pathlib import Path

import pytest

from benchmarks.proposal_scenes import ROOT, Example, demo
from gtm_hit.vision import detectors
from gtm_hit.vision.background import Backgrounds
from gtm_hit.vision.boxes import Box
from gtm_hit.vision.people import FrameProposals
from gtm_hit.vision.proposing import Method, Proposer, Settings


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


def look_once(folder: Path) -> LookedAt:
    """Whichever process comes first looks, the others wait for it and read what it found."""
    folder.mkdir(exist_ok=True)
    kept = folder / "looked-at.pickle"
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not kept.exists():
            kept.write_bytes(pickle.dumps(look(folder)))
        looked: LookedAt = pickle.loads(kept.read_bytes())
        return looked


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
