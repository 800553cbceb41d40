"""Actions a person and frame takes with real proposals: `python -m benchmarks.effort_real [--data FOLDER]`.

As `benchmarks.effort`, whose scripted annotator sees the truth, decides perfectly and goes on until everybody
is within 5 cm and validated; but frames, people and what is proposed are the demo scene's, and with FOLDER
MultiviewX's five annotated frames, too, as the built-in detector finds them (`make detector`), linked. The
same frames without proposals stand beside it.

*Side by side* everybody is seen in two tiles; whoever stands wrong is clicked on there, and one key accepts
the rest and goes on. Pointing at a tile counts as an action. *By the eye*: nothing tells the annotator
whether somebody stands right; feet and ring are looked at in the tiles, as unsurely as the hand clicks, and
the table says for how many that was right.
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
from playwright.sync_api import Browser, sync_playwright

from benchmarks.effort import CHROMIUM, FRAME_STEP, annotate, person, print_row, scene
from benchmarks.proposal_scenes import ROOT, Example, demo, multiviewx
from benchmarks.proposal_scores import Found, followed_people, is_annotated
from benchmarks.proposals import Kept, run
from gtm_hit.vision import detectors
from gtm_hit.vision.boxes import Detector
from gtm_hit.vision.people import Proposal
from gtm_hit.vision.proposing import Method, Settings

CERTAIN = 0.7  # least score of whom one key accepts, as the server says
FILLED = 0.7  # score of whom the linking alone puts into a hole
HANDS = {"far": True, "clicks": True}
SHEET = {**HANDS, "sheet": True, "proposals": True}
PLANS: dict[str, dict[str, Any]] = {
    "without proposals, one by one": {**HANDS, "round": True, "skip": True},
    "without proposals, side by side": {**HANDS, "sheet": True},
    "real proposals accepted, the others mended": {**HANDS, "proposals": True},
    "real proposals, side by side": SHEET,
    "… clicks that miss by 1 CSS pixel": {**SHEET, "screen": 1},
    "… by the eye": {**SHEET, "screen": 1, "eyes": True},
}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--detector", type=Path, help="the detector's file, else DATA_DIR's")
    parser.add_argument("--data", type=Path, help="folder that holds multiviewx")
    parser.add_argument("--plan", default="", help="part of the name of the plans to run, else all")
    options = parser.parse_args()
    detector = detectors.built_in(Path(os.environ.get("DATA_DIR", ROOT / "var")), options.detector)
    if detector is None:
        print("No detector (make detector): nobody is proposed.")
        return
    cv2.setNumThreads(1)
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder, sync_playwright() as playwright:
        examples = [demo(Path(os.environ.get("DEMO_FOLDER", folder)))]
        if options.data:
            examples.append(multiviewx(options.data / "multiviewx"))
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        for example in examples:
            plans = {name: plan for name, plan in PLANS.items() if options.plan in name}
            tell(browser, example, proposed_in(example, detector), plans)
        browser.close()


def proposed_in(example: Example, detector: Detector) -> Found:
    found, _seconds = run(example, Method.COVER, Kept(example, detector), Settings())
    return found


def tell(browser: Browser, example: Example, found: Found, plans: dict[str, dict[str, Any]]) -> None:
    """The table of one example's annotated frames."""
    frames = [dict(_positions(example, frame)) for frame in sorted(example.known)]
    told = scene(len(frames), list(example.scene.cameras.values()), example.scene.grid, example.scene.rule)
    print(f"{example.name}: {len(frames)} frames, {sum(map(len, frames))} people\n")
    print(f"{'actions per person and frame':<52}{'all':>6}{'arrows':>8}{'keys':>6}{'clicks':>8}")
    for name, plan in plans.items():
        print_row(name, annotate(browser, frames, plan, answer(example, found), told))
    print()


def _positions(example: Example, frame: int) -> Iterator[tuple[int, int]]:
    known = example.known[frame]
    return zip(known.persons.tolist(), example.scene.grid.position(known.xy).tolist(), strict=True)


def answer(example: Example, found: Found) -> dict[str, Any]:
    """What the server says about these proposals; whom the annotations cannot know is left out."""
    numbers, followed = count(), followed_people(found)
    known = {(frame, each.x, each.y): each for frame, one in enumerate(found) for each in one.people}
    told: list[dict[str, Any]] = [
        {"number": frame * FRAME_STEP, "people": [], "refused": []} for frame in sorted(example.known)
    ]
    identities = followed.identities()
    for frame, one in enumerate(told):
        rows = (followed.frames == frame).nonzero()[0]
        rows = rows[is_annotated(example, followed.xy[rows], example.known[frame].xy)]
        for track, (x, y) in zip(identities[rows].tolist(), followed.xy[rows].tolist(), strict=True):
            each = known.get((frame, x, y))
            score = each.score if each else FILLED
            told_of = person(next(numbers), track, (x, y), score, example.scene.grid)
            one["people"].append({**told_of, "evidence": evidence_of(each)})
    return {"run": 1, "threshold": CERTAIN, "frames": told}


def evidence_of(each: Proposal | None) -> list[dict[str, Any]]:
    return [
        {"camera": view.camera, "box": view.box, "seen": None, "hidden": view.hidden}
        for view in (each.evidence if each else ())
    ]


if __name__ == "__main__":
    main()
