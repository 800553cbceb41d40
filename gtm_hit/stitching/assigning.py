"""Who goes on as whom: the best of all answers at once, and how much better it is than without each pair."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from gtm_hit.stitching.tracks import Floats, Ids


@dataclass(frozen=True)
class Pair:
    row: int
    column: int
    lead: float  # log odds over the best answer that says otherwise about this pair


@dataclass(frozen=True)
class Answer:
    pairs: list[Pair]
    refused: list[Pair]  # nearly as good as what was chosen instead; `lead` is by how much they fell behind


def assign(odds: Floats, margin: float) -> Answer:
    """The best pairing under log odds (N, M), -inf for what cannot be; anybody may stay alone."""
    answer = Answer([], [])
    for rows, columns in _islands(odds > -margin):
        _assign_island(odds[np.ix_(rows, columns)], rows, columns, margin, answer)
    return answer


def _islands(possible: NDArray[np.bool_]) -> list[tuple[Ids, Ids]]:
    """Groups of rows and columns that compete with each other; nearly always one of each."""
    count = sum(possible.shape)
    rows, columns = np.nonzero(possible)
    graph = coo_array((np.ones(len(rows)), (rows, columns + possible.shape[0])), shape=(count, count))
    _, island = connected_components(graph, directed=False)
    groups = np.split(np.argsort(island, kind="stable"), np.cumsum(np.bincount(island))[:-1])
    height = possible.shape[0]
    return [(group[group < height], group[group >= height] - height) for group in groups if len(group) > 1]


def _assign_island(odds: Floats, rows: Ids, columns: Ids, margin: float, answer: Answer) -> None:
    best, chosen = _solve(odds)
    for row, column in zip(*np.nonzero(np.isfinite(odds)), strict=True):
        other = odds.copy()
        if (row, column) in chosen:
            other[row, column] = -np.inf
            lead = best - _solve(other)[0]
            answer.pairs.append(Pair(int(rows[row]), int(columns[column]), lead))
        else:
            other[row], other[:, column] = -np.inf, -np.inf
            lead = best - _solve(other)[0] - float(odds[row, column])
            if lead < margin:
                answer.refused.append(Pair(int(rows[row]), int(columns[column]), lead))


def _solve(odds: Floats) -> tuple[float, set[tuple[int, int]]]:
    """The sum of the best pairing's log odds, and its pairs."""
    gain = np.maximum(np.nan_to_num(odds, neginf=0.0), 0.0)
    rows, columns = linear_sum_assignment(gain, maximize=True)
    taken = gain[rows, columns] > 0
    return float(gain[rows, columns].sum()), set(
        zip(rows[taken].tolist(), columns[taken].tolist(), strict=True)
    )
