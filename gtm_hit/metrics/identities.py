"""Which identity of one side is which of the other, over all frames at once."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import min_weight_full_bipartite_matching

from gtm_hit.metrics.annotations import Ids


def going_together(first: Ids, second: Ids) -> int:
    """How many of the pairs (K,) of identities hold under the best one-to-one renaming of one side.

    Memory grows with the different pairs, not with everybody times everybody: hours of a busy place have
    tens of thousands of people.
    """
    if not len(first):
        return 0
    pairs, together = np.unique(np.column_stack((first, second)), axis=0, return_counts=True)
    _, rows = np.unique(pairs[:, 0], return_inverse=True)
    _, columns = np.unique(pairs[:, 1], return_inverse=True)
    # The matching has to be full: everybody may also be renamed to nobody, a column of their own.
    people, others = int(rows.max()) + 1, int(columns.max()) + 1
    nobody = int(together.max()) + 1
    cost = coo_array(
        (
            np.concatenate((nobody - together, np.full(people, nobody))).astype(np.float64),
            (
                np.concatenate((rows, np.arange(people))),
                np.concatenate((columns, others + np.arange(people))),
            ),
        ),
        shape=(people, others + people),
    ).tocsr()
    chosen = min_weight_full_bipartite_matching(cost)
    return round(people * nobody - float(cost[chosen].sum()))
