"""Actions a person and frame takes with the demo scene's real proposals: `python -m benchmarks.effort_real`.

As `benchmarks.effort`, whose scripted annotator sees the truth, decides perfectly and goes on until everybody
is within 5 cm and validated; but the ten frames, their people and what is proposed are the demo scene's, as
the built-in detector finds them (`make detector`), linked. Who scores 0.7 is accepted by one key, the others
are placed or mended by hand. The same frames without proposals stand beside it.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import cv2
from playwright.sync_api import sync_playwright

from benchmarks.effort import CHROMIUM, FRAME_STEP, annotate, person, print_row
from benchmarks.proposal_scenes import ROOT, Example, demo
from benchmarks.proposal_scores import Found, followed_people
from benchmarks.proposals import Kept, run
from gtm_hit.vision import detectors
from gtm_hit.vision.proposing import Method, Settings

CERTAIN = 0.7  # least score of whom one key accepts, as the server says
FILLED = 0.7  # score of whom the linking alone puts into a hole
HANDS = {"far": True, "clicks": True}
PLANS: dict[str, dict[str, Any]] = {
    "without proposals, one by one": {**HANDS, "round": True, "skip": True},
    "real proposals accepted, the others mended": {**HANDS, "proposals": True},
}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--detector", type=Path, help="the detector's file, else DATA_DIR's")
    options = parser.parse_args()
    detector = detectors.built_in(Path(os.environ.get("DATA_DIR", ROOT / "var")), options.detector)
    if detector is None:
        print("No detector (make detector): nobody is proposed.")
        return
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder:
        example = demo(Path(os.environ.get("DEMO_FOLDER", folder)))
        cv2.setNumThreads(1)
        found, _seconds = run(example, Method.COVER, Kept(example, detector), Settings())
    frames = [dict(_positions(example, frame)) for frame in sorted(example.known)]
    print(f"{len(frames)} frames, {sum(map(len, frames))} people\n")
    print(f"{'actions per person and frame':<52}{'all':>6}{'arrows':>8}{'keys':>6}{'clicks':>8}")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        for name, plan in PLANS.items():
            print_row(name, annotate(browser, frames, plan, answer(found, len(frames))))
        browser.close()


def _positions(example: Example, frame: int) -> Iterator[tuple[int, int]]:
    known = example.known[frame]
    return zip(known.persons.tolist(), example.scene.grid.position(known.xy).tolist(), strict=True)


def answer(found: Found, frames: int) -> dict[str, Any]:
    """What the server says about these proposals."""
    numbers, followed = count(), followed_people(found)
    scores = {(frame, each.x, each.y): each.score for frame, one in enumerate(found) for each in one.people}
    told: list[dict[str, Any]] = [
        {"number": frame * FRAME_STEP, "people": [], "refused": []} for frame in range(frames)
    ]
    rows = zip(followed.frames.tolist(), followed.xy.tolist(), followed.identities().tolist(), strict=True)
    for frame, (x, y), track in rows:
        told[frame]["people"].append(person(next(numbers), track, (x, y), scores.get((frame, x, y), FILLED)))
    return {"run": 1, "threshold": CERTAIN, "frames": told}


if __name__ == "__main__":
    main()
