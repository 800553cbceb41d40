"""How long the metrics take on scenes of WILDTRACK's size and larger: `python -m benchmarks.metrics`."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics import agreement, detection, figures, hota, statistics, tracking
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.metrics.coverage import coverage

PEOPLE = 24  # in every frame, as in WILDTRACK
STAY = 100  # frames, then the next 24 people come


def scene(frames: int) -> tuple[Annotations, Annotations]:
    """People at random places that somebody else annotated 20 cm off, missing every tenth."""
    rng = np.random.default_rng(1)
    frame, slot = (values.ravel() for values in np.mgrid[0:frames, 0:PEOPLE])
    places = rng.uniform((-3.0, -9.0), (9.0, 27.0), (len(frame), 2))
    person = frame // STAY * PEOPLE + slot
    kept = rng.random(len(frame)) < 0.9
    noisy = places + rng.normal(0.0, 0.2, places.shape)
    return Annotations(frame, places, person), Annotations(frame[kept], noisy[kept], person[kept])


def fastest(work: Callable[[], object], times: int = 3) -> float:
    took = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        took.append(time.perf_counter() - start)
    return min(took)


def report(name: str, work: Callable[[], object], times: int = 3) -> None:
    print(f"{name:<62} {fastest(work, times):8.3f} s", flush=True)


def main() -> None:
    truth, found = scene(400)
    size = f"400 frames × {PEOPLE} people"
    report(f"MODA, MODP, precision, recall, {size}", lambda: detection.evaluate(truth, found))
    report(f"their curve over 20 radii, {size}", lambda: detection.curve(truth, found))
    report(f"MOTA, IDF1, switches and HOTA, {size}", lambda: tracking.evaluate(truth, found))
    report(f"HOTA alone, {size}", lambda: hota.evaluate(truth, found))
    report(
        f"agreement of 3 workers, {size}", lambda: agreement.evaluate({"a": truth, "b": found, "c": truth})
    )
    long_truth, long_found = scene(36_000)
    size = f"36,000 frames × {PEOPLE} people"
    report(f"MODA, MODP, precision, recall, {size}", lambda: detection.evaluate(long_truth, long_found), 1)
    report(f"HOTA alone, {size}", lambda: hota.evaluate(long_truth, long_found), 1)
    report(f"MOTA, IDF1, switches and HOTA, {size}", lambda: tracking.evaluate(long_truth, long_found), 1)
    numbers = np.arange(36_000)
    report(f"tracks, {size}", lambda: statistics.tracks_of(long_truth, numbers), 1)
    report(f"speeds, {size}", lambda: statistics.speeds(long_truth, numbers, 0.5), 1)
    grid = Grid(480, 1440, 0.025, -3.0, -9.0)
    visible = np.random.default_rng(1).random((7, grid.count)) < 0.5
    report("coverage of all 691,200 positions, 7 cameras", lambda: coverage(grid, visible))
    every_eighth = coverage(grid, visible, 8)
    report(
        "its map, noise instead of areas (worst case), every 8th",
        lambda: figures.coverage_map(every_eighth, title=""),
    )


if __name__ == "__main__":
    main()
