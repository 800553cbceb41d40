"""Linking of sequences of any length, window by window: its price grows with the frames and not faster."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gtm_hit.vision.link import FILLED, NOBODY, Floats, Ids, Linked, LinkSettings, Places, link

WINDOW = 120  # frames linked at once
OVERLAP = 12  # frames that two windows share: the second knows the people of the first


def linked_in_windows(frames: Ids, xy: Floats, settings: LinkSettings) -> Linked:
    """As `link` does, of places nobody has a name for."""
    tracks, certainty = np.full(len(frames), NOBODY), np.ones(len(frames))
    filled: list[Linked] = []
    free = 1  # the smallest number nobody has
    for start, fresh, end in _windows(frames):
        rows = np.flatnonzero((frames >= start) & (frames < end))
        known = np.where(frames[rows] < fresh, tracks[rows], NOBODY)
        part = link(Places(frames[rows], xy[rows], known), settings)
        names = _named(part.tracks, known, free)
        free = max(free, int(names.max(initial=0)) + 1)
        new = (part.rows != FILLED) & (part.frames >= fresh)
        tracks[rows[part.rows[new]]] = names[new]
        certainty[rows[part.rows[new]]] = part.certainty[new]
        # A hole just before what is new: the window before may not have seen its other side.
        holes = (part.rows == FILLED) & (part.frames >= fresh - settings.fill)
        if filled:
            before = set(zip(filled[-1].tracks.tolist(), filled[-1].frames.tolist(), strict=True))
            holes &= [at not in before for at in zip(names.tolist(), part.frames.tolist(), strict=True)]
        filled.append(_taken(part, holes, names))
    found = np.flatnonzero(tracks != NOBODY)
    whole = Linked(found, frames[found], xy[found], tracks[found], certainty[found])
    columns = zip(*(_columns(part) for part in (whole, *filled)), strict=True)
    return Linked(*(np.concatenate(column) for column in columns))


def _taken(part: Linked, rows: Ids, names: Ids) -> Linked:
    return Linked(part.rows[rows], part.frames[rows], part.xy[rows], names[rows], part.certainty[rows])


def _columns(linked: Linked) -> tuple[Ids, Ids, Floats, Ids, Floats]:
    return linked.rows, linked.frames, linked.xy, linked.tracks, linked.certainty


def _windows(frames: Ids) -> Iterator[tuple[int, int, int]]:
    """First frame, first frame that is new, end."""
    if not len(frames):
        return
    fresh, last = int(frames.min()), int(frames.max()) + 1
    start = fresh
    while fresh < last:
        end = min(start + WINDOW, last)
        yield start, fresh, end
        fresh, start = end, end - OVERLAP


def _named(tracks: Ids, known: Ids, free: int) -> Ids:
    """Known tracks keep their numbers, the others get free ones."""
    names = tracks.copy()
    unknown = ~np.isin(tracks, known[known != NOBODY])
    _each, index = np.unique(tracks[unknown], return_inverse=True)
    names[unknown] = free + index
    return names
