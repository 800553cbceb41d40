"""How many who were taken out of finished annotations are listed: `python -m benchmarks.missing`.

With `--trajectories FOLDER` recorded walkers, else made ones (see benchmarks.linking); proposals of them
degraded with a seed, 20 people taken out at random. Scores of the proposals are made up: real people
0.9 ± 0.08, others 0.3 to 0.8. Nothing was tuned on these.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from benchmarks.linking import DEGRADATIONS, degraded, made, read
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.vision.link import FILLED, LinkSettings
from gtm_hit.vision.missing import Area, Case, Marked, Seen, find
from gtm_hit.vision.windows import linked_in_windows

TAKEN = 20
FRAMES = 60  # of a layer
FOUND = 0.5  # metres between somebody taken out and the place that is listed


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
            np.hypot(*(truth.xy[truth.frames == frame] - xy).T).min(initial=9) < FOUND
            for frame, xy in zip(places.frames, places.xy, strict=True)
        ]
    )
    scores = np.where(near, rng.normal(0.9, 0.08, len(near)), rng.uniform(0.3, 0.8, len(near))).clip(0, 1)
    linked = linked_in_windows(places.frames, places.xy, LinkSettings())
    tracks = np.full(len(places.frames), -1)
    own = linked.rows != FILLED
    tracks[linked.rows[own]] = linked.tracks[own]
    return Seen(places.frames, places.xy, scores, tracks)


def listed(truth: Annotations, seen: Seen, taken: np.ndarray) -> tuple[float, float]:
    """Share of those taken out that are listed, and other places per five frames."""
    kept = np.delete(np.arange(len(truth)), taken)
    marked = Marked(truth.frames[kept], truth.xy[kept], truth.identities()[kept])
    (west, south), (east, north) = truth.xy.min(axis=0), truth.xy.max(axis=0)
    cases = find(marked, seen, FRAMES, Area(west, south, east, north))
    hits = {row for row in taken.tolist() if any(_about(case, truth, row) for case in cases)}
    false = [case for case in cases if not any(_about(case, truth, row) for row in taken.tolist())]
    return len(hits) / len(taken), 5 * len(false) / FRAMES


def _about(case: Case, truth: Annotations, row: int) -> bool:
    x, y = truth.xy[row]
    return bool(case.frame == truth.frames[row] and np.hypot(case.x - x, case.y - y) < FOUND)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trajectories", type=Path, help="folder of text files: frame person x y")
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    files = sorted(options.trajectories.glob("*.txt")) if options.trajectories else []
    sequences = {file.stem: read(file) for file in files} or {"made": made(0)}
    print(
        f"{'listed of ' + str(TAKEN) + ' / false per 5 frames':<34}"
        + "".join(f"{how:>18}" for how in DEGRADATIONS)
    )
    for name, whole in sequences.items():
        cells = ""
        for how in DEGRADATIONS:
            scores = []
            for seed in range(options.seeds):
                rng = np.random.default_rng(seed)
                truth = busy_part(whole, rng)
                taken = rng.choice(len(truth), min(TAKEN, len(truth)), replace=False)
                scores.append(listed(truth, proposed(truth, how, seed), taken))
            share, false = np.mean(scores, axis=0)
            cells += f"{100 * share:>10.1f} % /{false:>4.1f}"
        print(f"{name:<34}{cells}", flush=True)


if __name__ == "__main__":
    main()
