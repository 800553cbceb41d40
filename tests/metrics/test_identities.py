from __future__ import annotations

from collections import Counter
from itertools import permutations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.metrics.identities import going_together

PAIRS = st.lists(st.tuples(st.integers(1, 4), st.integers(11, 14)), max_size=25)


@given(PAIRS)
def test_no_other_renaming_keeps_more_pairs(pairs: list[tuple[int, int]]) -> None:
    together = Counter(pairs)
    best = max(
        sum(together[pair] for pair in zip((1, 2, 3, 4), renamed, strict=True))
        for renamed in permutations((11, 12, 13, 14))
    )
    first, second = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    assert going_together(first, second) == best


def test_somebody_may_stay_without_a_partner() -> None:
    first, second = np.array([1, 1, 2]), np.array([5, 5, 5])
    assert going_together(first, second) == 2
