"""After how much known truth workers can be told apart, simulated on the demo scene's walkers, no pictures.

`python -m benchmarks.worker_scores [--json] [--batches 30]` lets four kinds of workers do batch after batch.
Every batch has one gold frame in ten and two planted faults in every other one. Everybody starts with the
people of a tracker that is 8 cm off, misses 4 % and invents 2 %. Printed are scores with their intervals, and
after how many batches the interval of each lies wholly below the careful worker's.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import dataclass

import numpy as np

from gtm_hit.demo.render import truth as demo_people
from gtm_hit.demo.scene import read_scene
from gtm_hit.geometry.grid import Grid
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.scoring import truth
from gtm_hit.scoring.evidence import Evidence
from gtm_hit.scoring.faults import ALL_KINDS, Positions, plant, planted, repaired
from gtm_hit.scoring.plausibility import count_warnings
from gtm_hit.scoring.suspicion import Usual, careless, suspicion
from gtm_hit.scoring.worker import Score, score

FRAMES, GOLD_EVERY, FAULTS = 10, 10, 2
SHOWN = (1, 2, 5, 10, 20, 30)
Frames = dict[int, Positions]


@dataclass(frozen=True)
class Kind:
    """`looks`: the share of the people whom the worker looks at; the others stay as he found them."""

    name: str
    looks: float
    noise: float  # metres, of those he looks at
    misses: float
    invents: float
    seconds: float  # per person
    drops: float = 0.0  # share of his batches that he leaves in the middle


KINDS = (
    Kind("careful", 1.0, 0.04, 0.01, 0.002, 4.0),
    Kind("sloppy", 0.5, 0.14, 0.06, 0.02, 2.5),
    Kind("next-presser", 0.0, 0.0, 0.0, 0.0, 0.2),
    Kind("vanishing", 1.0, 0.05, 0.015, 0.004, 4.0, drops=0.5),
)


def scene() -> tuple[Frames, Grid]:
    described = read_scene()
    frames: Frames = {}
    for row in demo_people(described):
        place = int(described.grid.nearest([(row.x, row.y)])[0])
        frames.setdefault(row.number, {})[row.person] = place
    return frames, described.grid


def moved(place: int, grid: Grid, noise: float, rng: np.random.Generator) -> int:
    return int(grid.nearest(grid.metres([place]) + rng.normal(0, noise, (1, 2)))[0])


def tracker(right: Frames, grid: Grid, rng: np.random.Generator) -> Frames:
    """What everybody starts with."""
    found = {
        number: {p: moved(at, grid, 0.08, rng) for p, at in people.items() if rng.random() >= 0.04}
        for number, people in right.items()
    }
    for people in found.values():
        invented = rng.random(len(people)) < 0.02
        for index in np.flatnonzero(invented).tolist():
            people[9000 + index] = int(rng.integers(grid.count))
    return found


def worked(kind: Kind, given: Frames, right: Frames, grid: Grid, rng: np.random.Generator) -> Frames:
    """Whoever looks at a person puts it right by the pictures, as well as he can."""
    return {number: one_frame(kind, given[number], right[number], grid, rng) for number in given}


def one_frame(
    kind: Kind, given: Positions, right: Positions, grid: Grid, rng: np.random.Generator
) -> Positions:
    made: Positions = {}
    for person in sorted(given.keys() | right.keys()):
        if rng.random() >= kind.looks:
            if person in given:
                made[person] = given[person]
        elif person in right and rng.random() >= kind.misses:
            made[person] = moved(right[person], grid, kind.noise, rng)
    for index in np.flatnonzero(rng.random(len(right)) < kind.invents).tolist():
        made[8000 + index] = int(rng.integers(grid.count))
    return made


def in_metres(frames: Frames, numbers: list[int], grid: Grid) -> Annotations:
    rows = [(number, p, at) for number in numbers for p, at in sorted(frames[number].items())]
    table = np.array(rows, np.int64).reshape(-1, 3)
    return Annotations(table[:, 0], grid.metres(table[:, 2]), table[:, 1])


def batch(kind: Kind, index: int, all_frames: Frames, grid: Grid, seed: int) -> Evidence:
    """What is counted in one batch; the same seed makes the same."""
    rng = np.random.default_rng([seed, index, KINDS.index(kind)])
    if rng.random() < kind.drops:
        return Evidence(dropped=1)
    numbers = sorted(all_frames)
    start = (index * FRAMES) % (len(numbers) - FRAMES + 1)
    right = {number: all_frames[number] for number in numbers[start : start + FRAMES]}
    before = tracker(right, grid, rng)
    faults = plant(before, grid, ALL_KINDS, FAULTS, rng) if index % 2 == 0 else []
    shown = planted(before, faults)
    now = worked(kind, shown, right, grid, rng)
    gold = sorted(right)[:: max(1, GOLD_EVERY)]
    judged = truth.score(in_metres(right, gold, grid), in_metres(now, gold, grid))
    people = sum(map(len, now.values()))
    pairs = [(now[n].get(p), at) for n, given in shown.items() for p, at in given.items() if p in now[n]]
    untouched = sum(here == at for here, at in pairs)
    return Evidence(
        gold_frames=len(gold),
        truth=judged.truth,
        found=judged.found,
        matched=judged.matched,
        placed=judged.placed,
        same=min(judged.together, judged.matched),
        faults=len(faults),
        repaired=sum(repaired(one, before, now, grid) for one in faults),
        people=people,
        seconds=people * kind.seconds,
        carried=len(pairs),
        untouched=untouched,
        edits=len(pairs) - untouched,
        warnings=count_warnings(in_metres(now, sorted(now), grid), 0.1),
        finished=1,
    )


def scores_of(
    kind: Kind, batches: int, frames: Frames, grid: Grid, seed: int
) -> list[tuple[Evidence, Score]]:
    """After each batch."""
    total, made = Evidence(), []
    usual = Usual(seconds=4.0, untouched=0.1, edits=0.8, warnings=0.01)
    for index in range(batches):
        one = batch(kind, index, frames, grid, seed)
        total += one + Evidence(careless=careless(one, usual))
        made.append((total, score(total, MEASURED)))
    return made


MEASURED = frozenset({"found", "placed", "identity", "faults", "plausible", "care", "finishing"})


def separated(mine: list[tuple[Evidence, Score]], best: list[tuple[Evidence, Score]]) -> Evidence | None:
    """What was known when the intervals lay apart, for good."""
    apart = [one[1].high < other[1].low for one, other in zip(mine, best, strict=True)]
    first = next((index for index in range(len(apart)) if all(apart[index:])), None)
    return None if first is None else mine[first][0]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--batches", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    started = time.perf_counter()
    frames, grid = scene()
    found = {kind.name: scores_of(kind, given.batches, frames, grid, given.seed) for kind in KINDS}
    if given.json:
        print(json.dumps(as_numbers(found)))
        return
    print(
        f"{len(frames)} frames, {given.batches} batches of {FRAMES}; score (interval) after so many batches"
    )
    shown = [number for number in SHOWN if number <= given.batches]
    print(f"{'':<14}" + "".join(f"{number:>16}" for number in shown))
    for name, made in found.items():
        print(f"{name:<14}" + "".join(f"{in_words(made[number - 1][1]):>16}" for number in shown))
    for name, numbers in as_numbers(found).items():
        if name != "careful":
            print(f"{name}: apart from careful after {apart_in_words(numbers)}")
    usual = Usual(seconds=4.0, untouched=0.1, edits=0.8, warnings=0.01)
    for kind in KINDS:
        doubts = [suspicion(batch(kind, i, frames, grid, given.seed), usual).value for i in range(10)]
        print(f"{kind.name}: suspicion of a batch {np.median(doubts):.2f} (median of 10)")
    print(f"{time.perf_counter() - started:.1f} s")


def in_words(one: Score) -> str:
    return f"{one.score:.0f} ({one.low:.0f}–{one.high:.0f})"


def apart_in_words(numbers: dict[str, float | None]) -> str:
    if numbers["apart_after_batches"] is None:
        return "more batches than these"
    parts = (("batches", "batches"), ("gold_frames", "gold frames"), ("faults", "planted faults"))
    return ", ".join(f"{numbers[f'apart_after_{key}']:.0f} {words}" for key, words in parts)


def as_numbers(found: dict[str, list[tuple[Evidence, Score]]]) -> dict[str, dict[str, float | None]]:
    numbers: dict[str, dict[str, float | None]] = {}
    for name, made in found.items():
        last = made[-1][1]
        known = separated(made, found["careful"])
        numbers[name] = {
            "score": round(last.score, 1),
            "low": round(last.low, 1),
            "high": round(last.high, 1),
            "apart_after_batches": known and known.finished + known.dropped,
            "apart_after_gold_frames": known and known.gold_frames,
            "apart_after_faults": known and known.faults,
        }
    return numbers


if __name__ == "__main__":
    main()
