"""Several annotations of one person in one frame, made one place."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gtm_hit.stitching.tracks import Floats, Ids, Track

SLIP = 0.25  # metres from the middle at which a place is somebody's slip, not noise


def place_of(points: Floats, weights: Floats) -> Floats:
    """The weighted mean of those points (N, 2) that lie near their median: one slip moves nothing."""
    if len(points) < 3:
        return _mean(points, weights)
    away = np.hypot(*(points - np.median(points, axis=0)).T)
    kept = away <= max(SLIP, float(np.median(away)))
    return _mean(points[kept], weights[kept])


def merged(tracks: Sequence[Track]) -> Track:
    """One person out of several tracks, which may have frames in common."""
    frames = np.concatenate([track.frames for track in tracks])
    xy = np.concatenate([track.xy for track in tracks])
    votes = [vote for track in tracks for vote in track.votes]
    order = np.argsort(frames, kind="stable")
    found, starts = np.unique(frames[order], return_index=True)
    groups = np.split(order, starts[1:])
    places = np.stack(
        [xy[group[0]] if len(group) == 1 else place_of(xy[group], _alike(group)) for group in groups]
    )
    together = tuple(tuple(source for row in group.tolist() for source in votes[row]) for group in groups)
    return Track(frozenset().union(*(track.sources for track in tracks)), found, places, together)


def latest(track: Track, count: int) -> Track:
    """Its last frames."""
    return Track(track.sources, track.frames[-count:], track.xy[-count:], track.votes[-count:])


def _alike(group: Ids) -> Floats:
    return np.ones(len(group))


def _mean(points: Floats, weights: Floats) -> Floats:
    mean: Floats = np.average(points, axis=0, weights=weights)
    return mean
