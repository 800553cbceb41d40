"""The demo scene's truth against a scripted, imperfect layer, by our metrics, by motmetrics and by TrackEval.

`python -m benchmarks.imperfect_layer` prints them side by side.
"""

from __future__ import annotations

import motmetrics
import numpy as np

from gtm_hit.demo.render import truth
from gtm_hit.demo.scene import read_scene
from gtm_hit.metrics import detection, tracking
from gtm_hit.metrics.annotations import Annotations, Ids, by_frame
from gtm_hit.metrics.matching import RADIUS, distances_between
from tests.metrics import trackeval_scores
from tests.metrics.scenes import imperfect


def demo_truth() -> Annotations:
    rows = truth(read_scene())
    return Annotations(
        np.array([row.number for row in rows]),
        np.array([[row.x, row.y] for row in rows]),
        np.array([row.person for row in rows]),
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
        "DetA": identity.hota.detection,
        "AssA": identity.hota.association,
        "LocA": identity.hota.localisation,
    }


def _ids(annotations: Annotations, rows: Ids) -> list[int]:
    return annotations.identities()[rows].tolist()


def main() -> None:
    people = demo_truth()
    found = imperfect(people, np.random.default_rng(1))
    ours, others = (
        by_ours(people, found),
        (by_motmetrics(people, found), trackeval_scores.scores(people, found)),
    )
    print(f"{len(people)} annotations in {len(np.unique(people.frames))} frames; {len(found)} in the layer")
    print(f"{'':<14}{'ours':>10}{'motmetrics':>12}{'TrackEval':>12}")
    for name, value in ours.items():
        cells = (f"{scores[name]:12.4f}" if name in scores else f"{'–':>12}" for scores in others)
        print(f"{name:<14}{value:10.4f}{''.join(cells)}")


if __name__ == "__main__":
    main()
