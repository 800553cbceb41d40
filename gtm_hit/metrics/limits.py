"""How much can be compared: matching looks at everybody of a frame with everybody of the other side."""

from __future__ import annotations

import numpy as np

from gtm_hit.metrics.annotations import Annotations, MetricsError

MOST_PEOPLE = 500  # of one side in one frame, as many as a frame of a layer holds; their table takes 2 MB
MOST_PAIRS = 10_000_000  # over all frames of a request; WILDTRACK's 400 frames have 0.25 million


class TooManyPeople(MetricsError):
    """More than fit into memory; says where, and how many would."""


def check_size(truth: Annotations, found: Annotations, most_pairs: int | None = None) -> None:
    """TooManyPeople for a frame, or with `most_pairs` for frames, that would not fit into memory."""
    numbers = np.union1d(truth.frames, found.frames)
    counts = [_counts(side, numbers) for side in (truth, found)]
    for count in counts:
        if len(count) and count.max() > MOST_PEOPLE:
            frame = int(numbers[np.argmax(count)])
            raise TooManyPeople(
                f"{count.max()} people are in frame {frame}; at most {MOST_PEOPLE} are compared"
            )
    pairs = int(counts[0] @ counts[1])
    if most_pairs is not None and pairs > most_pairs:
        raise TooManyPeople(
            f"{pairs} pairs of people would have to be compared, more than {most_pairs}; compare fewer frames"
        )


def _counts(side: Annotations, numbers: np.ndarray) -> np.ndarray:
    return np.bincount(np.searchsorted(numbers, side.frames), minlength=len(numbers)).astype(np.int64)
