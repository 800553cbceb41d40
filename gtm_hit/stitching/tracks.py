"""What is stitched: people of one batch as tracks on the ground."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
Source = tuple[int, int]  # an annotated layer, and a person in it: what stays when stitching runs again


@dataclass(frozen=True, eq=False)
class Track:
    """One person of one batch."""

    sources: frozenset[Source]
    frames: Ids  # (K,) instants counted along the dataset, ascending, at least one
    xy: Floats  # (K, 2) metres
    votes: tuple[tuple[Source, ...], ...]  # (K,) the annotations each place was made of

    @property
    def first(self) -> int:
        return int(self.frames[0])

    @property
    def last(self) -> int:
        return int(self.frames[-1])

    @property
    def place_in_order(self) -> tuple[float, ...]:
        """Sorts people by where they are, never by how somebody numbered them."""
        return (self.first, *self.xy[0].tolist(), self.last, *self.xy[-1].tolist())


@dataclass(frozen=True, eq=False)
class Batch:
    """Frames annotated together by one worker, or by several and fused."""

    frames: Ids  # (F,) instants it covers, ascending; also those with nobody
    tracks: tuple[Track, ...]

    @property
    def first(self) -> int:
        return int(self.frames[0])

    @property
    def last(self) -> int:
        return int(self.frames[-1])


def batch(layer: int, covered: Iterable[int], frames: Ids, persons: Ids, xy: Floats) -> Batch:
    """A worker's batch out of plain columns, a row per annotation in any order."""
    order = np.lexsort((frames, persons))
    frames, persons, xy = frames[order], persons[order], xy[order]
    names, starts = np.unique(persons, return_index=True)
    ends = np.append(starts, len(persons))[1:]
    tracks = []
    for name, start, end in zip(names.tolist(), starts.tolist(), ends.tolist(), strict=True):
        source = (layer, name)
        votes = ((source,),) * (end - start)
        tracks.append(Track(frozenset([source]), frames[start:end], xy[start:end], votes))
    return Batch(np.unique(np.fromiter(covered, np.int64)), in_order(tracks))


def in_order(tracks: Sequence[Track]) -> tuple[Track, ...]:
    return tuple(sorted(tracks, key=lambda track: track.place_in_order))
