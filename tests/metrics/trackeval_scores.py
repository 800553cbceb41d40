"""TrackEval's scores of places on the ground."""

from __future__ import annotations

import contextlib
import io
from typing import Any

import numpy as np

from gtm_hit.metrics.annotations import Annotations, by_frame
from gtm_hit.metrics.matching import RADIUS, distances_between

with contextlib.redirect_stdout(io.StringIO()):  # names every benchmark whose parts are not installed
    from trackeval import metrics

SILENT = {"PRINT_CONFIG": False}


def scores(truth: Annotations, found: Annotations, radius: float = RADIUS) -> dict[str, float]:
    """HOTA's similarity is 1 at no distance and 0 at `radius`; the other metrics match up to `radius`."""
    exact = metrics.HOTA().eval_sequence(sequence(truth, found, radius))
    matched = sequence(truth, found, 2 * radius)  # a similarity of a half, their threshold, at `radius`
    identity = metrics.Identity(SILENT).eval_sequence(matched)
    clear = metrics.CLEAR(SILENT).eval_sequence(matched)
    return {
        "MOTA": float(clear["MOTA"]),
        "swapped": int(clear["IDSW"]),
        "IDF1": float(identity["IDF1"]),
        "ID precision": float(identity["IDP"]),
        "ID recall": float(identity["IDR"]),
        **{name: float(exact[name].mean()) for name in ("HOTA", "DetA", "AssA", "LocA")},
    }


def sequence(truth: Annotations, found: Annotations, reach: float) -> dict[str, Any]:
    """`reach`: metres at which two places are not similar any more."""
    frames = list(by_frame(truth, found))
    truth_ids, found_ids = (np.unique(side.identities(), return_inverse=True)[1] for side in (truth, found))
    return {
        "gt_ids": [truth_ids[rows] for _, rows, _ in frames],
        "tracker_ids": [found_ids[others] for _, _, others in frames],
        "similarity_scores": [
            np.maximum(0.0, 1.0 - distances_between(truth.xy[rows], found.xy[others]) / reach)
            for _, rows, others in frames
        ],
        "num_gt_ids": int(truth_ids.max(initial=-1)) + 1,
        "num_tracker_ids": int(found_ids.max(initial=-1)) + 1,
        "num_gt_dets": len(truth),
        "num_tracker_dets": len(found),
        "num_timesteps": len(frames),
    }
