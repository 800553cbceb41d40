"""Small random scenes for property tests."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from gtm_hit.metrics.annotations import Annotations

# Positions of a small grid, so that shared places and distances of exactly the radius happen often.
CELLS = st.tuples(st.integers(0, 40), st.integers(0, 40))
STEP = 0.025


def places(most: int = 5) -> st.SearchStrategy[np.ndarray]:
    return st.lists(CELLS, max_size=most).map(lambda cells: np.array(cells, float).reshape(-1, 2) * STEP)


@st.composite
def layers(draw: st.DrawFn, frames: int = 4, people: int = 4) -> Annotations:
    """A layer with identities: any people of a few, in any of a few frames, anywhere."""
    keys = draw(
        st.lists(
            st.tuples(st.integers(0, frames - 1), st.integers(0, people - 1)),
            unique=True,
            max_size=frames * people,
        )
    )
    cells = draw(st.lists(CELLS, min_size=len(keys), max_size=len(keys)))
    numbers, persons = np.array(keys, int).reshape(-1, 2).T
    return Annotations(numbers * 5, np.array(cells, float).reshape(-1, 2) * STEP, persons)
