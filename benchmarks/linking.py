"""How well people are linked over time: `python -m benchmarks.linking [--trajectories FOLDER]`.

Real or made walkers, degraded with a seed: places off, people missed, people who are not there, pairs that
stand close seen as one. Settings were tuned on TUNED_ON; the other sequences are the report.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gtm_hit.metrics import tracking
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.vision.link import Linked, LinkSettings, Places, link

TUNED_ON = ("crowds_zara01", "students003")
FRAMES_APART = 10  # in the files
BATCH = 10


@dataclass(frozen=True)
class Degradation:
    noise: float  # metres
    missed: float
    false: float
    merged_below: float = 0.35  # metres; such pairs become one half the time


DEGRADATIONS = {
    "good": Degradation(0.04, 0.015, 0.005),
    "medium": Degradation(0.08, 0.07, 0.05),
    "bad": Degradation(0.12, 0.17, 0.10),
}


def read(file: Path) -> Annotations:
    rows = np.loadtxt(file)
    return Annotations(
        (rows[:, 0] / FRAMES_APART).astype(np.int64), rows[:, 2:4], rows[:, 1].astype(np.int64)
    )


def made(seed: int, frames: int = 100, people: int = 24) -> Annotations:
    """Walkers of our own where no recorded ones are given: straight, with slow turns."""
    rng = np.random.default_rng(seed)
    at = rng.uniform((0, 0), (12, 16), (people, 2))
    heading, pace = rng.uniform(0, 2 * np.pi, people), rng.uniform(0.0, 0.7, people)
    steps = []
    for _ in range(frames):
        steps.append(at.copy())
        heading = heading + rng.normal(0, 0.12, people)
        heading = np.where(((at < 0) | (at > (12, 16))).any(axis=1), np.arctan2(*(8 - at).T[::-1]), heading)
        at = at + (pace * np.array([np.cos(heading), np.sin(heading)])).T
    number, person = np.mgrid[0:frames, 0:people]
    return Annotations(number.ravel(), np.concatenate(steps), person.ravel())


def degraded(truth: Annotations, how: Degradation, seed: int) -> Places:
    rng = np.random.default_rng(seed)
    frames, places = [], []
    for frame in np.unique(truth.frames):
        xy = truth.xy[truth.frames == frame]
        apart = np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))
        merged = np.zeros(len(xy), bool)
        seen = xy.copy()
        for one, other in zip(*np.nonzero(np.triu(apart < how.merged_below, 1)), strict=True):
            if rng.random() < 0.5 and not (merged[one] or merged[other]):
                seen[one] = (xy[one] + xy[other]) / 2
                merged[other] = True
        kept = ~merged & (rng.random(len(xy)) >= how.missed)
        false = rng.uniform(truth.xy.min(axis=0), truth.xy.max(axis=0), (rng.binomial(len(xy), how.false), 2))
        now = np.concatenate((seen[kept] + rng.normal(0, how.noise, (int(kept.sum()), 2)), false))
        places.append(now)
        frames.append(np.full(len(now), frame))
    return Places(np.concatenate(frames), np.concatenate(places))


def scored(truth: Annotations, linked: Linked) -> tracking.TrackingScore:
    return tracking.evaluate(truth, Annotations(linked.frames, linked.xy, linked.tracks)).score


def milliseconds_of_batches(places: Places) -> list[float]:
    took = []
    for start in range(int(places.frames.min()), int(places.frames.max()), BATCH):
        rows = (places.frames >= start) & (places.frames < start + BATCH)
        began = time.perf_counter()
        link(Places(places.frames[rows], places.xy[rows]))
        took.append((time.perf_counter() - began) * 1000)
    return took


def row(truth: Annotations, settings: LinkSettings, seeds: int) -> list[tuple[float, float, float]]:
    """IDF1, MOTA and switches of each degradation."""
    result = []
    for how in DEGRADATIONS.values():
        scores = [scored(truth, link(degraded(truth, how, seed), settings)) for seed in range(seeds)]
        result.append(
            (
                100 * float(np.mean([each.idf1 for each in scores])),
                100 * float(np.mean([each.mota for each in scores])),
                float(np.mean([each.switches for each in scores])),
            )
        )
    return result


def _cells(scores: Sequence[Sequence[float]]) -> str:
    return "".join(f"{idf1:>10.1f} /{mota:>5.1f} /{switches:>5.0f}" for idf1, mota, switches in scores)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trajectories", type=Path, help="folder of text files: frame person x y")
    parser.add_argument("--seeds", type=int, default=2)
    options = parser.parse_args()
    files = sorted(options.trajectories.glob("*.txt")) if options.trajectories else []
    sequences = {file.stem: read(file) for file in files if file.stem != "README"} or {
        f"made {seed}": made(seed) for seed in range(3)
    }
    print(f"{'IDF1 / MOTA / switches':<26}" + "".join(f"{name:>24}" for name in DEGRADATIONS))
    reported = []
    for name, truth in sequences.items():
        tuned = name in TUNED_ON
        scores = row(truth, LinkSettings(), options.seeds)
        reported += [] if tuned else [scores]
        print(f"{name + (' (tuned)' if tuned else ''):<26}{_cells(scores)}", flush=True)
    mean = np.mean(reported, axis=0)
    print(
        f"{'mean of those not tuned on':<26}"
        + "".join(f"{a:>10.1f} /{b:>5.1f} /{c:>5.0f}" for a, b, c in mean)
    )
    took = [
        ms
        for truth in sequences.values()
        for ms in milliseconds_of_batches(degraded(truth, DEGRADATIONS["medium"], 0))
    ]
    print(f"a batch of {BATCH} frames: median {np.median(took):.0f} ms, worst {max(took):.0f} ms")


if __name__ == "__main__":
    main()
