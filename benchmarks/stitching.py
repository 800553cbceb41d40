"""How well many small batches become one layer: `python -m benchmarks.stitching`.

Simulated workers annotate the demo scene's crowd, or the people of a file (`frame person x y`, metres):
5 cm of noise in X and in Y, 3 % missed, 1 % extra, everybody numbered anew in every batch. Somebody who is
away for longer than the gap counts as somebody new when coming back, in the truth as well: such returns are
proposed to people, never joined, and are counted apart.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from benchmarks import stitching_data as data
from gtm_hit.metrics.annotations import Annotations, by_frame
from gtm_hit.metrics.identities import going_together
from gtm_hit.metrics.matching import RADIUS, distances_between, is_near, match
from gtm_hit.stitching.fusing import fuse
from gtm_hit.stitching.merging import merged
from gtm_hit.stitching.rules import Rules
from gtm_hit.stitching.stitching import Stitched, stitch
from gtm_hit.stitching.tracks import Source, Track

HOUR = 3600  # batches: 36,000 frames, every one of an hour at ten frames a second
SEEDS = 3


@dataclass(frozen=True)
class Outcome:
    """One run over one truth."""

    idf1: float
    perfect: float  # with every join between neighbours right
    joins: int
    wrong: int  # joins of two different people, or with somebody who is not there
    missed: int  # joins not made
    missed_unasked: int  # of these, those the queue does not ask about
    queued: int
    returns: int  # proposed
    right_returns: int
    left: int  # people who came back after longer than the gap

    @property
    def wrong_per_500(self) -> float:
        return 500 * self.wrong / self.joins if self.joins else 0.0


def run(truth: data.Truth, overlap: int, seed: int) -> Outcome:
    rng = np.random.default_rng((seed, overlap))
    worked = [
        data.annotate(truth, covered, layer, rng, data.Workers())
        for layer, covered in enumerate(data.spans(truth, overlap))
    ]
    who = {source: person for each in worked for source, person in each.who.items()}
    rules = Rules(seconds=truth.seconds)
    stitched = stitch([[each.batch] for each in worked], rules)
    tracks = [track for each in worked for track in each.batch.tracks]
    seen = [(who[_only(track)], track) for track in tracks if who[_only(track)] >= 0]
    return _judged(data.parted(truth, rules.gap, seen), tracks, who, stitched, rules)


def _judged(
    truth: Annotations, tracks: Sequence[Track], who: dict[Source, int], stitched: Stitched, rules: Rules
) -> Outcome:
    """Against a truth in which nobody is away for longer than the gap."""
    person_of = {source: index for index, track in enumerate(stitched.people) for source in track.sources}
    right = _perfect(tracks, who, rules.gap)
    chains = [sorted(track.sources) for track in stitched.people]
    pairs = [pair for chain in chains for pair in pairwise(chain)]
    wrong = sum(who[one] != who[other] or who[one] < 0 for one, other in pairs)
    links = [
        (one, other)
        for person in right
        for one, other in pairwise(person)
        if person_of[_only(one)] != person_of[_only(other)]
    ]
    asked = {source for doubt in stitched.doubts for source in doubt.before.sources | doubt.after.sources}
    unasked = sum(_only(one) not in asked or _only(other) not in asked for one, other in links)
    came = [who[_only(back.before)] == who[_only(back.after)] >= 0 for back in stitched.returns]
    people = {who[_only(tracks[0])] for tracks in right if who[_only(tracks[0])] >= 0}
    real = sum(who[_only(tracks[0])] >= 0 for tracks in right)
    return Outcome(
        idf1=idf1(truth, stitched.people),
        perfect=idf1(truth, [merged(tracks) for tracks in right]),
        joins=stitched.joins,
        wrong=wrong,
        missed=len(links),
        missed_unasked=unasked,
        queued=len(stitched.doubts),
        returns=len(stitched.returns),
        right_returns=sum(came),
        left=real - len(people),
    )


def _only(track: Track) -> Source:
    (source,) = track.sources
    return source


def _perfect(tracks: Sequence[Track], who: dict[Source, int], gap: int) -> list[list[Track]]:
    """Tracks of one person that follow each other within the gap; nobody's stay alone."""
    found: list[list[Track]] = []
    latest: dict[int, list[Track]] = {}
    for track in sorted(tracks, key=lambda each: (each.first, each.last)):
        person = who[_only(track)]
        before = latest.get(person)
        if person >= 0 and before and track.first - before[-1].last <= gap + 1:
            before.append(track)
        else:
            latest[person] = [track]
            found.append(latest[person])
    return found


def idf1(truth: Annotations, people: Sequence[Track]) -> float:
    found = Annotations(
        np.concatenate([track.frames for track in people]),
        np.concatenate([track.xy for track in people]),
        np.repeat(np.arange(len(people)), [len(track.frames) for track in people]),
    )
    near = [
        (rows[first], others[second])
        for _, rows, others in by_frame(truth, found)
        for first, second in [
            np.nonzero(is_near(distances_between(truth.xy[rows], found.xy[others]), RADIUS))
        ]
    ]
    ones, others = (np.concatenate(part) for part in zip(*near, strict=True))
    same = going_together(truth.identities()[ones], found.identities()[others])
    return 2 * same / (len(truth) + len(found))


def replica_error(truth: data.Truth, seed: int, replicas: int = 3) -> float:
    """Mean centimetres between fused and true places of all who are there in both."""
    rng = np.random.default_rng((seed, 7))
    rules, distances = Rules(seconds=truth.seconds), []
    for covered in data.spans(truth, 1):
        copies = [data.annotate(truth, covered, n, rng, data.Workers()).batch for n in range(replicas)]
        tracks = fuse(copies, rules).batch.tracks
        if tracks:
            found = Annotations(
                np.concatenate([track.frames for track in tracks]),
                np.concatenate([track.xy for track in tracks]),
            )
            there = np.flatnonzero(np.isin(truth.people.frames, covered))
            distances.append(match(truth.people.take(there), found).distances)
    return 100 * float(np.concatenate(distances).mean())


def hour(seed: int) -> dict[str, float]:
    """An hour's batches, their people over and over: seconds and the most memory of stitching them."""
    truth = data.demo(seed)
    rng = np.random.default_rng((seed, 9))
    spans, count = data.spans(truth, 1), data.FRAMES
    groups = []
    for layer in range(HOUR):
        turn, index = divmod(layer, len(spans))
        groups.append(
            [data.moved(data.annotate(truth, spans[index], layer, rng, data.Workers()).batch, turn * count)]
        )
    before, start = _peak(), time.perf_counter()
    stitch(groups, Rules(seconds=truth.seconds))
    seconds, memory = time.perf_counter() - start, _peak() - before
    return {"batches": HOUR, "seconds": round(seconds, 1), "memory_mb": round(memory)}


def _peak() -> float:
    """Most megabytes this process has had in memory."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def report(path: Path | None, seeds: Sequence[int]) -> dict[str, object]:
    """Means over the seeds; counts are summed."""
    truths = [data.read(path)] * len(seeds) if path else [data.demo(seed) for seed in seeds]
    with_overlap = [run(truth, 1, seed) for truth, seed in zip(truths, seeds, strict=True)]
    without = [run(truth, 0, seed) for truth, seed in zip(truths, seeds, strict=True)]
    errors = [replica_error(truth, seed) for truth, seed in zip(truths, seeds, strict=True)]
    return {
        "data": path.name if path else "demo",
        "seeds": list(seeds),
        "idf1_overlap": round(float(np.mean([one.idf1 for one in with_overlap])), 4),
        "idf1_no_overlap": round(float(np.mean([one.idf1 for one in without])), 4),
        "idf1_perfect": round(float(np.mean([one.perfect for one in with_overlap])), 4),
        "wrong_joins_per_500": round(
            500 * sum(o.wrong for o in with_overlap) / sum(o.joins for o in with_overlap), 3
        ),
        "queued": sum(one.queued for one in with_overlap),
        "mean_error_cm_3_replicas": round(float(np.mean(errors)), 2),
        "idf1_perfect_no_overlap": round(float(np.mean([one.perfect for one in without])), 4),
        "wrong_joins_per_500_no_overlap": round(
            500 * sum(o.wrong for o in without) / sum(o.joins for o in without), 3
        ),
        "queued_no_overlap": sum(one.queued for one in without),
        "overlap": [asdict(one) for one in with_overlap],
        "no_overlap": [asdict(one) for one in without],
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="one object, nothing else")
    parser.add_argument(
        "--trajectories", type=Path, metavar="FILE", help="people of this file instead of the demo's"
    )
    parser.add_argument("--seeds", type=int, nargs="+", default=list(range(1, SEEDS + 1)))
    parser.add_argument("--no-hour", action="store_true", help="leave out the 3,600 batches")
    options = parser.parse_args()
    found = report(options.trajectories, options.seeds)
    if not options.no_hour:
        found |= hour(options.seeds[0])
    if options.json:
        print(json.dumps(found))
    else:
        for name, value in found.items():
            print(f"{name:<32} {value}")


if __name__ == "__main__":
    main()
