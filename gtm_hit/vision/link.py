"""Who is whom over time: places of people, frame by frame, joined into tracks by min-cost flow.

A step is priced by how far it is from where the track before and the track after it would have put the
person, so that people who cross keep their identities. Velocities need tracks and tracks need velocities:
a Hungarian pass gives the first velocities, two passes of flow follow. The flow's linear programme has whole
solutions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment, linprog
from scipy.sparse import csr_array

from gtm_hit.metrics.matching import distances_between

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

NOBODY = -1  # a row without a track, a place that nothing was found at
FILLED = -1
DEAR = 50.0  # more than any price that is taken
SURE = 100.0  # outweighs any other price: what neighbours say is not to be argued with


@dataclass(frozen=True)
class LinkSettings:
    """Prices and gates; those of length are for a frame every 0.4 to 0.5 seconds."""

    gap: int = 4  # frames between two places of a track
    gate: float = 0.8  # metres that a step may be off …
    gate_per_gap: float = 0.25  # … and this much more for every frame of it
    entry: float = 5.0  # price of beginning a track
    found: float = 4.0  # gain of explaining a place
    sigma: float = 0.2  # metres, of what a prediction is off after one frame
    sigma_unknown: float = 0.45  # metres, of a step whose velocity nobody knows
    wait: float = 0.5  # price of every frame that a step leaves out
    memory: int = 3  # steps that a velocity is measured over
    fill: int = 2  # frames of a hole that are filled
    passes: int = 4  # at most


@dataclass(frozen=True, eq=False)
class Places:
    """What is to be linked, one row per person and frame, in any order."""

    frames: Ids  # (N,) counted 0, 1, 2 … along time
    xy: Floats  # (N, 2) metres
    persons: Ids | None = None  # (N,) of accepted neighbours; NOBODY where it is to be found out

    def known(self) -> Ids:
        return np.full(len(self.frames), NOBODY) if self.persons is None else self.persons


@dataclass(frozen=True, eq=False)
class Linked:
    """Tracks: what was given, and what fills their holes.

    rows : (M,) rows of the places; FILLED for a filled hole
    tracks : (M,) identities; rows that belong to no track are not there
    certainty : (M,) 0 to 1, of the step that leads here: how much worse the next best would be
    """

    rows: Ids
    frames: Ids
    xy: Floats
    tracks: Ids
    certainty: Floats


@dataclass(frozen=True, eq=False)
class _Steps:
    """Pairs of rows that may follow each other, and the frames between."""

    first: Ids
    second: Ids
    gaps: Ids


def link(places: Places, settings: LinkSettings | None = None) -> Linked:
    """Join places into tracks; persons of neighbours keep their numbers, others get numbers above theirs."""
    settings = settings or LinkSettings()
    steps = _possible(places, settings)
    following, prices = _cheapest(places, steps, settings)
    following = _without_contradictions(places, following, steps, prices)
    tracks = _named(places, following)
    certainty = _certainty(steps, prices, following, len(places.frames))
    return _filled(places, following, tracks, certainty, settings)


def _possible(places: Places, settings: LinkSettings) -> _Steps:
    """All pairs up to the largest gap that a person could walk, never two different known persons."""
    order = np.argsort(places.frames, kind="stable")
    frames = places.frames[order]
    firsts, seconds = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    for gap in range(1, settings.gap + 1):
        starts = np.searchsorted(frames, frames + gap, side="left")
        counts = np.searchsorted(frames, frames + gap, side="right") - starts
        firsts.append(np.repeat(order, counts))
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        seconds.append(order[np.repeat(starts, counts) + within])
    first, second = np.concatenate(firsts), np.concatenate(seconds)
    gaps = places.frames[second] - places.frames[first]
    known = places.known()
    same = (known[first] == known[second]) & (known[first] != NOBODY)
    apart = np.hypot(*(places.xy[second] - places.xy[first]).T)
    # A velocity moves the gate by what somebody fast walks; the price decides about the rest.
    near = apart < (settings.gate + settings.gate_per_gap) * gaps + settings.gate
    differ = (known[first] != NOBODY) & (known[second] != NOBODY) & ~same
    kept = (near & ~differ) | same
    return _Steps(first[kept], second[kept], gaps[kept])


def _hungarian(places: Places, settings: LinkSettings) -> Ids:
    """The row that follows each, (N,): frame by frame with constant velocity, for the first velocities."""
    following = np.full(len(places.frames), NOBODY)
    velocity = np.zeros_like(places.xy)
    gate = settings.gate + settings.gate_per_gap
    before = np.zeros(0, np.int64)
    last = None
    for frame in np.unique(places.frames).tolist():
        rows = np.flatnonzero(places.frames == frame)
        if last == frame - 1:
            apart = distances_between(places.xy[before] + velocity[before], places.xy[rows])
            # A pair beyond the gate costs what it costs not to pair.
            first, second = linear_sum_assignment(np.minimum(apart, gate))
            kept = apart[first, second] < gate
            one, other = before[first[kept]], rows[second[kept]]
            following[one] = other
            velocity[other] = places.xy[other] - places.xy[one]
        before, last = rows, frame
    return following


def _reverse(following: Ids) -> Ids:
    previous = np.full(len(following), NOBODY)
    rows = np.flatnonzero(following != NOBODY)
    previous[following[rows]] = rows
    return previous


def _velocity(places: Places, towards: Ids, memory: int) -> Floats:
    """Metres a frame, (N, 2), over the last steps in one direction of time; NaN where there is none."""
    end = np.arange(len(towards))
    for _ in range(memory):
        end = np.where(towards[end] != NOBODY, towards[end], end)
    took = (places.frames - places.frames[end]).astype(np.float64)
    took[took == 0] = np.nan
    velocity: Floats = (places.xy - places.xy[end]) / took[:, None]
    return velocity


def _prices(places: Places, steps: _Steps, following: Ids, settings: LinkSettings) -> Floats:
    """What each step costs, (K,); infinite beyond the gate.

    Forward by the track that led here, backward by the one that leads away: neither knows the step itself.
    """
    moved = places.xy[steps.second] - places.xy[steps.first]
    gaps = steps.gaps[:, None]
    memory = settings.memory
    forward = moved - _velocity(places, _reverse(following), memory)[steps.first] * gaps
    backward = moved - _velocity(places, following, memory)[steps.second] * gaps
    off = np.stack([np.hypot(*forward.T), np.hypot(*backward.T)])
    plain = np.hypot(*moved.T)
    spread = settings.sigma * np.sqrt(steps.gaps)
    known = ~np.isnan(off)
    squares = np.where(known, np.nan_to_num(off) / spread, plain / (settings.sigma_unknown * steps.gaps)) ** 2
    price = squares.mean(axis=0) / 2 + settings.wait * (steps.gaps - 1)
    worst = np.where(known, np.nan_to_num(off), plain).min(axis=0)
    price[worst > settings.gate + settings.gate_per_gap * (steps.gaps - 1) + settings.gate_per_gap] = np.inf
    price[_same_person(places, steps)] = -SURE
    return price


def _same_person(places: Places, steps: _Steps) -> NDArray[np.bool_]:
    known = places.known()
    same: NDArray[np.bool_] = (known[steps.first] == known[steps.second]) & (known[steps.first] != NOBODY)
    return same


def _flow(places: Places, steps: _Steps, prices: Floats, settings: LinkSettings) -> Ids:
    """The row that follows each in the cheapest flow, (N,); NOBODY at the end of a track."""
    count = len(places.frames)
    following = np.full(count, NOBODY)
    usable = np.flatnonzero(prices < settings.entry + 2 * settings.found)
    if not len(usable):
        return following
    first, second = steps.first[usable], steps.second[usable]
    # Variables: steps taken, tracks begun at a row, rows explained. Begun + taken into a row = explained,
    # and taken out of it at most as much.
    each = np.arange(count)
    n = len(usable)
    into = csr_array(
        (
            np.concatenate((np.ones(n), np.ones(count), -np.ones(count))),
            (np.concatenate((second, each, each)), np.arange(n + 2 * count)),
        )
    )
    out = csr_array(
        (
            np.concatenate((np.ones(n), -np.ones(count))),
            (np.concatenate((first, each)), np.concatenate((np.arange(n), n + count + each))),
        ),
        shape=(count, n + 2 * count),
    )
    gain = np.where(places.known() != NOBODY, SURE, settings.found)
    cost = np.concatenate((prices[usable], np.full(count, settings.entry), -gain))
    solved = linprog(
        cost, A_ub=out, b_ub=np.zeros(count), A_eq=into, b_eq=np.zeros(count), bounds=(0, 1), method="highs"
    )
    taken = solved.x[:n] > 0.5
    following[first[taken]] = second[taken]
    return following


def _cheapest(places: Places, steps: _Steps, settings: LinkSettings) -> tuple[Ids, Floats]:
    """The row that follows each, (N,), and what each step costs by the velocities that then are, (K,)."""
    following = _hungarian(places, settings)
    least, best, best_prices = np.inf, following, _prices(places, steps, following, settings)
    prices = best_prices
    for _ in range(settings.passes):
        before = following
        following = _adopted(places, _flow(places, steps, prices, settings), settings)
        prices = _prices(places, steps, following, settings)
        cost = _cost(steps, following, prices, settings)
        if cost < least:
            least, best, best_prices = cost, following, prices
        if np.array_equal(before, following):
            break
    return best, best_prices


def _cost(steps: _Steps, following: Ids, prices: Floats, settings: LinkSettings) -> float:
    """Of all tracks together."""
    taken = np.minimum(prices[following[steps.first] == steps.second], DEAR)
    chains = [len(chain) for chain in _chains(following) if len(chain) > 1]
    return float(taken.sum()) + settings.entry * len(chains) - settings.found * sum(chains)


def _adopted(places: Places, following: Ids, settings: LinkSettings) -> Ids:
    """With whoever has no track and no name and stands where a track has a hole, nearest first.

    A wrong step beside them may have made them too dear for the flow.
    """
    result = following.copy()
    alone = (following == NOBODY) & (_reverse(following) == NOBODY) & (places.known() == NOBODY)
    fitting: list[tuple[float, int, int]] = []
    for before in np.flatnonzero(following != NOBODY).tolist():
        after = int(following[before])
        gap = int(places.frames[after] - places.frames[before])
        for frame in range(1, gap):
            there = places.xy[before] + (places.xy[after] - places.xy[before]) * frame / gap
            rows = np.flatnonzero(alone & (places.frames == places.frames[before] + frame))
            off = np.hypot(*(places.xy[rows] - there).T)
            near = zip(off.tolist(), rows.tolist(), strict=True)
            fitting += [(away, before, row) for away, row in near if away < 2 * settings.sigma]
    for _away, before, row in sorted(fitting):
        last = before
        while places.frames[result[last]] < places.frames[row]:
            last = int(result[last])
        if alone[row] and places.frames[result[last]] > places.frames[row]:
            result[row], result[last] = result[last], row
            alone[row] = False
    return result


def _without_contradictions(places: Places, following: Ids, steps: _Steps, prices: Floats) -> Ids:
    """Cut tracks that two different known persons are on, at their dearest step between the two."""
    price = dict(zip(zip(steps.first.tolist(), steps.second.tolist(), strict=True), prices, strict=True))
    known, result = places.known(), following.copy()
    for track in _chains(following):
        owner, since = NOBODY, 0
        for at, row in enumerate(track):
            if known[row] == NOBODY:
                continue
            if owner not in (NOBODY, known[row]):
                cut = max(range(since, at), key=lambda i: price.get((track[i], track[i + 1]), np.inf))
                result[track[cut]] = NOBODY
            owner, since = int(known[row]), at
    return result


def _chains(following: Ids) -> list[list[int]]:
    previous = _reverse(following)
    chains = []
    for start in np.flatnonzero(previous == NOBODY).tolist():
        chain = [start]
        while following[chain[-1]] != NOBODY:
            chain.append(int(following[chain[-1]]))
        chains.append(chain)
    return chains


def _named(places: Places, following: Ids) -> Ids:
    """A track for each row, (N,); NOBODY for somebody seen once whom nobody knows."""
    known = places.known()
    tracks = np.full(len(known), NOBODY)
    fresh = int(known.max(initial=NOBODY)) + 1
    taken: set[tuple[int, int]] = {
        (person, frame) for person, frame in zip(known.tolist(), places.frames.tolist(), strict=True)
    }
    for chain in _chains(following):
        owners = known[chain][known[chain] != NOBODY]
        spots = [(int(places.frames[row]), row) for row in chain if known[row] == NOBODY]
        name = int(owners[0]) if len(owners) else NOBODY
        if name == NOBODY and len(chain) < 2:
            continue
        if name == NOBODY or any((name, frame) in taken for frame, _ in spots):
            name, fresh = fresh, fresh + 1
        tracks[chain] = np.where(known[chain] != NOBODY, known[chain], name)
        taken.update((name, frame) for frame, _ in spots)
    return tracks


def _certainty(steps: _Steps, prices: Floats, following: Ids, count: int) -> Floats:
    """Of the step that leads to each row, (N,): 1 where nobody else could come there, 0.5 where two could."""
    chain = np.zeros(count, dtype=np.int64)
    for number, rows in enumerate(_chains(following)):
        chain[rows] = number
    weight = np.exp(-np.clip(prices, 0.0, 50.0))
    taken = following[steps.first] == steps.second
    rival = chain[steps.first] != chain[steps.second]
    others = np.bincount(steps.second[rival], weight[rival], count) + np.exp(-5.0)
    result = np.ones(count)
    rows = steps.second[taken]
    result[rows] = weight[taken] / (weight[taken] + others[rows])
    return result


def _filled(places: Places, following: Ids, tracks: Ids, certainty: Floats, settings: LinkSettings) -> Linked:
    """With those between the two sides of a short hole, on the straight line."""
    rows = np.flatnonzero(tracks != NOBODY)
    parts = [(rows, places.frames[rows], places.xy[rows], tracks[rows], certainty[rows])]
    there = set(zip(tracks[rows].tolist(), places.frames[rows].tolist(), strict=True))
    before = rows[following[rows] != NOBODY]
    for first in before.tolist():
        second = int(following[first])
        missing = int(places.frames[second] - places.frames[first]) - 1
        if not 0 < missing <= settings.fill:
            continue
        at = np.arange(1, missing + 1)
        frames, track = places.frames[first] + at, int(tracks[second])
        if there.intersection((track, frame) for frame in frames.tolist()):
            continue
        part = (at / (missing + 1))[:, None]
        xy = places.xy[first] * (1 - part) + places.xy[second] * part
        none = np.full(missing, FILLED)
        parts.append((none, frames, xy, np.full(missing, track), np.full(missing, certainty[second] / 2)))
    return Linked(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def for_pace(seconds: float) -> LinkSettings:
    """Settings for a frame every so many seconds: what people walk grows with the time between."""
    usual = LinkSettings()
    factor = min(max(seconds / 0.45, 0.3), 3.0)
    return replace(
        usual,
        gate=usual.gate * factor,
        gate_per_gap=usual.gate_per_gap * factor,
        sigma_unknown=usual.sigma_unknown * factor,
    )
