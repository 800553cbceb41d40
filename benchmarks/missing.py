"""How many who were taken out of finished annotations are listed: `python -m benchmarks.missing`.

With the real proposals of the demo scene, and of MultiviewX where `--data FOLDER` holds it, if a detector is
there (`make detector`): 20 people are taken out of the annotations at random. Then with recorded walkers
(`--trajectories FOLDER`), else made ones (see benchmarks.linking): their places are degraded with a seed, and
scores are made up: real people 0.9 ± 0.08, others 0.3 to 0.8. Nothing was tuned on any of these.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from benchmarks.linking import DEGRADATIONS, degraded, made, read
from benchmarks.proposal_scenes import ROOT, Example, demo, multiviewx
from benchmarks.proposal_scores import SECONDS, Found, columns, is_annotated, truth_of
from benchmarks.proposals import Kept, run
from gtm_hit.geometry.cylinder import rectangles
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.vision import detectors
from gtm_hit.vision.boxes import as_array, overlaps
from gtm_hit.vision.link import FILLED, LinkSettings, for_pace
from gtm_hit.vision.missing import Area, Case, Marked, Seen, find
from gtm_hit.vision.proposing import Method, Settings
from gtm_hit.vision.windows import linked_in_windows

TAKEN = 20
FRAMES = 60  # of a layer of walkers
ABOUT = 0.5  # metres between somebody taken out and the place that is listed
BOXED = 0.3  # of intersection over union, from which on a box shows somebody


@dataclass(frozen=True, eq=False)
class Finished:
    """A layer without a fault, and what programs saw; `shown` says whom a box of any view shows."""

    truth: Annotations
    seen: Seen
    frames: int
    area: Area
    shown: np.ndarray | None = None


@dataclass(frozen=True)
class Listed:
    share: float  # of those taken out
    false: float  # other places per five frames


def listed(layer: Finished, taken: np.ndarray) -> Listed:
    truth = layer.truth
    kept = np.delete(np.arange(len(truth)), taken)
    shown = None if layer.shown is None else layer.shown[kept]
    marked = Marked(truth.frames[kept], truth.xy[kept], truth.identities()[kept], shown)
    cases = find(marked, layer.seen, layer.frames, layer.area)
    hits = {row for row in taken.tolist() if any(_about(case, truth, row) for case in cases)}
    false = [case for case in cases if not any(_about(case, truth, row) for row in taken.tolist())]
    return Listed(len(hits) / len(taken), 5 * len(false) / layer.frames)


def _about(case: Case, truth: Annotations, row: int) -> bool:
    x, y = truth.xy[row]
    return bool(case.frame == truth.frames[row] and np.hypot(case.x - x, case.y - y) < ABOUT)


def finished(example: Example, found: Found, kept: Kept) -> Finished:
    """Everybody annotated, and the proposals of the annotated frames inside the annotated area."""
    frames, xy, scores = columns(found)
    linked = linked_in_windows(frames, xy, for_pace(SECONDS))
    tracks = np.full(len(frames), -1)
    own = linked.rows != FILLED
    tracks[linked.rows[own]] = linked.tracks[own]
    filled = linked.rows == FILLED
    seen = Seen(
        np.concatenate((frames, linked.frames[filled])),
        np.concatenate((xy, linked.xy[filled])),
        np.concatenate((scores, np.full(int(filled.sum()), Settings().least))),
        np.concatenate((tracks, linked.tracks[filled])),
    )
    countable = np.zeros(len(seen.frames), bool)
    for frame, known in example.truth.items():
        rows = np.flatnonzero(seen.frames == frame)
        countable[rows] = is_annotated(example, seen.xy[rows], known)
    seen = Seen(*(column[countable] for column in (seen.frames, seen.xy, seen.scores, seen.tracks)))
    truth = truth_of(example)
    return Finished(truth, seen, len(example.truth), area_of(example), shown(example, kept, truth))


def area_of(example: Example) -> Area:
    grid = example.scene.grid
    width, length = grid.extent
    north = min(grid.origin_y + length, example.ends)
    return Area(grid.origin_x, grid.origin_y, grid.origin_x + width, north)


def shown(example: Example, kept: Kept, truth: Annotations) -> np.ndarray:
    """Whether a box of any view shows each of the annotations, as the server asks it."""
    scene, result = example.scene, np.zeros(len(truth), bool)
    positions = scene.grid.position(truth.xy)
    for name, camera in scene.cameras.items():
        boxes, visible = rectangles(camera, scene.grid, scene.cylinder, scene.rule, positions)
        for frame in example.truth:
            there = np.flatnonzero((truth.frames == frame) & visible)
            found = as_array(kept.boxes[frame][name])
            if len(found) and len(there):
                result[there] |= overlaps(boxes[there].astype(np.float64), found).max(axis=1) >= BOXED
    return result


def walkers(whole: Annotations, how: str, seed: int) -> Finished:
    truth = busy_part(whole, np.random.default_rng(seed))
    (west, south), (east, north) = truth.xy.min(axis=0), truth.xy.max(axis=0)
    return Finished(truth, proposed(truth, how, seed), FRAMES, Area(west, south, east, north))


def part(truth: Annotations, start: int) -> Annotations:
    rows = (truth.frames >= start) & (truth.frames < start + FRAMES)
    return Annotations(truth.frames[rows] - start, truth.xy[rows], truth.identities()[rows])


def busy_part(truth: Annotations, rng: np.random.Generator) -> Annotations:
    """Recorded walkers are not always there: one with at least twice as many as are taken out."""
    starts = rng.permutation(np.unique(truth.frames)).tolist()
    parts = (part(truth, start) for start in starts)
    return next(found for found in parts if len(found) >= 2 * TAKEN and found.frames.max() == FRAMES - 1)


def proposed(truth: Annotations, how: str, seed: int) -> Seen:
    rng = np.random.default_rng(seed)
    places = degraded(truth, DEGRADATIONS[how], seed)
    near = np.array(
        [
            np.hypot(*(truth.xy[truth.frames == frame] - xy).T).min(initial=9) < ABOUT
            for frame, xy in zip(places.frames, places.xy, strict=True)
        ]
    )
    scores = np.where(near, rng.normal(0.9, 0.08, len(near)), rng.uniform(0.3, 0.8, len(near))).clip(0, 1)
    linked = linked_in_windows(places.frames, places.xy, LinkSettings())
    tracks = np.full(len(places.frames), -1)
    own = linked.rows != FILLED
    tracks[linked.rows[own]] = linked.tracks[own]
    return Seen(places.frames, places.xy, scores, tracks)


def drawn(layer: Finished, seed: int) -> np.ndarray:
    count = len(layer.truth)
    return np.random.default_rng(seed).choice(count, min(TAKEN, count), replace=False)


def real_rows(data: Path | None, detector: detectors.NanoDet, seeds: int) -> Iterator[str]:
    cv2.setNumThreads(1)
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder:
        examples = [multiviewx(data / "multiviewx")] if data else []
        for example in [*examples, demo(Path(os.environ.get("DEMO_FOLDER", folder)))]:
            kept = Kept(example, detector)
            found, _seconds = run(example, Method.COVER, kept, Settings())
            layer = finished(example, found, kept)
            yield f"{example.name + ', real proposals':<34}{cell([layer] * seeds)}"


def cell(layers: list[Finished]) -> str:
    scores = [listed(layer, drawn(layer, seed)) for seed, layer in enumerate(layers)]
    share, false = np.mean([(each.share, each.false) for each in scores], axis=0)
    return f"{100 * share:>10.1f} % /{false:>4.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder with multiviewx")
    parser.add_argument("--detector", type=Path, help="the detector's file, else DATA_DIR's")
    parser.add_argument("--trajectories", type=Path, help="folder of text files: frame person x y")
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    print(f"{f'listed of {TAKEN} / false per 5 frames':<34}")
    detector = detectors.built_in(Path(os.environ.get("DATA_DIR", ROOT / "var")), options.detector)
    if detector:
        for line in real_rows(options.data, detector, 10 * options.seeds):
            print(line, flush=True)
    files = sorted(options.trajectories.glob("*.txt")) if options.trajectories else []
    sequences = {file.stem: read(file) for file in files} or {"made": made(0)}
    print(" " * 34 + "".join(f"{how:>18}" for how in DEGRADATIONS))
    for name, whole in sequences.items():
        cells = (cell([walkers(whole, how, seed) for seed in range(options.seeds)]) for how in DEGRADATIONS)
        print(f"{name:<34}{''.join(cells)}", flush=True)


if __name__ == "__main__":
    main()
