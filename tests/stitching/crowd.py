"""People on straight ways, cut into batches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from gtm_hit.stitching.tracks import Batch, batch

Ways = Mapping[int, tuple[tuple[float, float], tuple[float, float]]]  # where at frame 0, metres per frame


def cut(
    layer: int,
    frames: Sequence[int],
    ways: Ways,
    *,
    names: Mapping[int, int] | None = None,
    absent: Sequence[tuple[int, int]] = (),
    off: tuple[float, float] = (0.0, 0.0),
) -> Batch:
    """The batch of a worker who numbers people as `names` says and is `off` by so many metres."""
    rows = [
        (frame, person if names is None else names[person], *np.add(start, np.multiply(step, frame)) + off)
        for frame in frames
        for person, (start, step) in ways.items()
        if (person, frame) not in absent
    ]
    table = np.array(rows, dtype=np.float64).reshape(-1, 4)
    return batch(layer, frames, table[:, 0].astype(int), table[:, 1].astype(int), table[:, 2:])


def people(tracks: Sequence[object]) -> set[frozenset[tuple[int, int]]]:
    """Who is one person, without any numbering."""
    return {track.sources for track in tracks}  # type: ignore[attr-defined]
