"""The demo scene's truth against a scripted, imperfect layer, by our metrics and by motmetrics' own.

`python -m benchmarks.imperfect_layer` prints both side by side.
"""

from __future__ import annotations

import motmetrics
import numpy as np

from gtm_hit.demo.render import truth
from gtm_hit.demo.scene import read_scene
from gtm_hit.metrics import detection, tracking
from gtm_hit.metrics.annotations import Annotations, Ids, by_frame
from gtm_hit.metrics.matching import RADIUS, distances_between

MISSED, INVENTED, SWAPS = 0.08, 0.05, 5
NOISE, BIAS = 0.08, (0.04, -0.02)  # metres


def demo_truth() -> Annotations:
    rows = truth(read_scene())
    return Annotations(
        np.array([row.number for row in rows]),
        np.array([[row.x, row.y] for row in rows]),
        np.array([row.person for row in rows]),
    )


def imperfect(people: Annotations, rng: np.random.Generator) -> Annotations:
    """Everybody a little off and to one side, some missed, some invented, some who go on as somebody else."""
    persons = people.identities().copy()
    frames = np.unique(people.frames)
    for frame in rng.choice(frames[1:], SWAPS, replace=False):
        one, other = rng.choice(np.unique(persons[people.frames == frame]), 2, replace=False)
        later = people.frames >= frame
        mine, theirs = later & (persons == one), later & (persons == other)
        persons[mine], persons[theirs] = other, one
    kept = rng.random(len(people)) >= MISSED
    xy = people.xy + BIAS + rng.normal(0.0, NOISE, people.xy.shape)
    invented = np.flatnonzero(rng.random(len(people)) < INVENTED)
    low, high = people.xy.min(axis=0), people.xy.max(axis=0)
    return Annotations(
        np.concatenate((people.frames[kept], people.frames[invented])),
        np.concatenate((xy[kept], rng.uniform(low, high, (len(invented), 2)))),
        np.concatenate((persons[kept], persons.max() + 1 + np.arange(len(invented)))),
    )


def by_motmetrics(people: Annotations, found: Annotations) -> dict[str, float]:
    events = motmetrics.MOTAccumulator()
    for number, rows, others in by_frame(people, found):
        distances = distances_between(people.xy[rows], found.xy[others])
        distances[distances >= RADIUS] = np.nan
        events.update(_ids(people, rows), _ids(found, others), distances, frameid=number)
    names = ["mota", "motp", "idf1", "idp", "idr", "num_switches", "precision", "recall"]
    names += ["num_misses", "num_false_positives", "num_objects"]
    row = motmetrics.metrics.create().compute(events, metrics=names).iloc[0]
    mistakes = row["num_misses"] + row["num_false_positives"]
    return {
        "MODA": 1 - mistakes / row["num_objects"],
        "MODP": 1 - row["motp"] / RADIUS,
        "precision": row["precision"],
        "recall": row["recall"],
        "missed": row["num_misses"],
        "extra": row["num_false_positives"],
        "MOTA": row["mota"],
        "MOTP": 1 - row["motp"] / RADIUS,
        "IDF1": row["idf1"],
        "ID precision": row["idp"],
        "ID recall": row["idr"],
        "swapped": row["num_switches"],
    }


def by_ours(people: Annotations, found: Annotations) -> dict[str, float]:
    ground, identity = detection.evaluate(people, found), tracking.evaluate(people, found).score
    return {
        "MODA": ground.moda,
        "MODP": ground.modp,
        "precision": ground.precision,
        "recall": ground.recall,
        "missed": ground.missed,
        "extra": ground.extra,
        "MOTA": identity.mota,
        "MOTP": identity.motp,
        "IDF1": identity.idf1,
        "ID precision": identity.id_precision,
        "ID recall": identity.id_recall,
        "swapped": identity.switches,
        "HOTA": identity.hota.hota,
    }


def _ids(annotations: Annotations, rows: Ids) -> list[int]:
    return annotations.identities()[rows].tolist()


def main() -> None:
    people = demo_truth()
    found = imperfect(people, np.random.default_rng(1))
    ours, theirs = by_ours(people, found), by_motmetrics(people, found)
    print(f"{len(people)} annotations in {len(np.unique(people.frames))} frames; {len(found)} in the layer")
    print(f"{'':<14}{'ours':>10}{'motmetrics':>12}")
    for name, value in ours.items():
        other = f"{theirs[name]:12.4f}" if name in theirs else f"{'–':>12}"
        print(f"{name:<14}{value:10.4f}{other}")


if __name__ == "__main__":
    main()
