"""How well a rough click is put right: `python -m benchmarks.snap [--data FOLDER] [--detector FILE]`.

Everybody annotated is marked 20 to 40 cm off, in a direction drawn with a seed, and snapped: with all others
marked where they stand, and as the first one marked in the frame; proposals explain the boxes of whoever is
not marked, and in the last row nobody does. FOLDER holds `multiviewx` as in the published sample; the demo
scene, which the project renders itself, is always scored. Heights are not told. Foregrounds are those a run
keeps.

The outline and the weight of the foreground were chosen on MultiviewX's frames 0-2 and the demo scene's
frames 0-4, looking at 30 settings. The detector and the fit had been tuned on MultiviewX's frames 0-4 and the
demo scene's frames 0-4 (see benchmarks.proposals). Nothing was tuned on the demo scene's frames 5-9.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.proposals import FRAMES, ROOT, Example, Kept, demo, multiviewx, run
from gtm_hit.vision import detectors
from gtm_hit.vision.background import Backgrounds
from gtm_hit.vision.masks import Notes, packed, unpacked
from gtm_hit.vision.proposing import Method, Settings
from gtm_hit.vision.snap import USUAL, Marks, SnapSettings, snap, with_unmarked

OFF = (0.2, 0.4)  # metres
CERTAIN = 0.7  # of the score: as in `ops.proposals.snapping`
PARTS = {"MultiviewX": (range(3), range(3, FRAMES)), "demo scene": (range(5), range(5, FRAMES))}


Proposed = Sequence[NDArray]  # of each frame (N, 3) x, y, height


@dataclass(frozen=True)
class Case:
    frame: int
    marks: Marks
    truth: NDArray


def cases(
    example: Example, frames: Sequence[int], alone: bool, seed: int, proposed: Proposed | None
) -> Iterator[Case]:
    rng = np.random.default_rng(seed)
    for frame in frames:
        known = example.truth[frame]
        bodies = np.column_stack((known, np.full(len(known), USUAL)))
        for row, body in enumerate(bodies):
            angle, off = rng.uniform(0, 2 * np.pi), rng.uniform(*OFF)
            click = body + np.array((off * np.cos(angle), off * np.sin(angle), 0))
            marks = Marks(click, np.zeros((0, 3)) if alone else np.delete(bodies, row, axis=0))
            yield Case(frame, with_unmarked(marks, proposed[frame]) if proposed else marks, body[:2])


def measured(
    example: Example, kept: Kept, masks: Sequence[Mapping[str, NDArray]], found: Sequence[Case]
) -> str:
    settings, cameras = SnapSettings(), example.scene.cameras
    before, after, moved = [], [], 0
    start = time.process_time()
    for case in found:
        boxes, mask = kept.boxes[case.frame], masks[case.frame] if masks else None
        snapped = snap(case.marks, boxes, cameras, mask, settings)
        before.append(np.hypot(*(case.marks.one[:2] - case.truth)))
        after.append(np.hypot(*(np.array([snapped.x, snapped.y]) - case.truth)))
        moved += snapped.refused is None
    each = 1000 * (time.process_time() - start) / len(found)
    off = 100 * np.array(after)
    worse = 100 * np.mean(np.array(after) > np.array(before))
    shares = "".join(f"{100 * np.mean(off < limit):7.1f}" for limit in (5, 10, 20))
    last = f"{worse:7.1f}{100 * moved / len(found):7.1f}{each:7.0f}"
    return f"{np.mean(off):7.1f}{np.median(off):7.1f}{shares}{last}"


def seen_in(example: Example) -> list[dict[str, NDArray]]:
    """Foregrounds of all frames as a run keeps them."""
    notes = Notes(Backgrounds.learn(example.frames[:FRAMES], example.scene.cameras))
    kept = []
    for frame in example.frames:
        for name, each in notes.backgrounds.cameras.items():
            each.foreground(frame[name])
        kept.append(unpacked(packed(notes.take())))
    return kept


def proposed_in(example: Example, kept: Kept) -> list[NDArray]:
    """Those of whom a run is sure."""
    found, _seconds = run(example, Method.COVER, kept, Settings())
    return [
        np.array([(one.x, one.y, one.height) for one in frame.people if one.score >= CERTAIN]).reshape(-1, 3)
        for frame in found
    ]


def table(example: Example, detector: detectors.NanoDet, seed: int) -> Iterator[str]:
    kept, masks = Kept(example, detector), seen_in(example)
    proposed = proposed_in(example, kept)
    for frames in PARTS[example.name]:
        chosen = [frame for frame in frames if frame in example.truth]
        title = f"{example.name}, frames {min(chosen)}-{max(chosen)}"
        marked = list(cases(example, chosen, False, seed, proposed))
        yield f"{title + ', others marked, boxes':<50}{measured(example, kept, [], marked)}"
        yield f"{'… and background':<50}{measured(example, kept, masks, marked)}"
        first = list(cases(example, chosen, True, seed, proposed))
        yield f"{'… the first one marked, boxes':<50}{measured(example, kept, [], first)}"
        yield f"{'… and background':<50}{measured(example, kept, masks, first)}"
        alone = list(cases(example, chosen, True, seed, None))
        yield f"{'… and nobody explained':<50}{measured(example, kept, masks, alone)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder with multiviewx")
    parser.add_argument("--detector", type=Path, help="the detector's file, else DATA_DIR's")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    cv2.setNumThreads(1)
    detector = detectors.built_in(Path(os.environ.get("DATA_DIR", ROOT / "var")), options.detector)
    if detector is None:
        raise SystemExit("No detector (make detector): there are no boxes to snap to.")
    heads = ("mean", "median", "<5", "<10", "<20 %", "worse", "moved", "ms")
    print(f"{'cm off':<50}" + "".join(f"{head:>7}" for head in heads))
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as made:
        examples = [multiviewx(options.data / "multiviewx")] if options.data else []
        for example in [*examples, demo(Path(os.environ.get("DEMO_FOLDER", made)))]:
            for line in table(example, detector, options.seed):
                print(line, flush=True)


if __name__ == "__main__":
    main()
