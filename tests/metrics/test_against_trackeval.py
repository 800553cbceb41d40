"""HOTA and IDF1 as the reference implementation computes them, here and now."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given

from gtm_hit.formats.annotations import frame_column_row
from gtm_hit.metrics import tracking
from gtm_hit.metrics.annotations import Annotations
from tests.metrics import trackeval_scores
from tests.metrics.scenes import crossing_people, imperfect, linked
from tests.metrics.strategies import layers


def ours(truth: Annotations, found: Annotations, radius: float) -> dict[str, float]:
    score = tracking.evaluate(truth, found, radius).score
    return {
        "IDF1": score.idf1,
        "ID precision": score.id_precision,
        "ID recall": score.id_recall,
        "HOTA": score.hota.hota,
        "DetA": score.hota.detection,
        "AssA": score.hota.association,
        "LocA": score.hota.localisation,
    }


def theirs(truth: Annotations, found: Annotations, radius: float) -> dict[str, float]:
    scores = trackeval_scores.scores(truth, found, radius)
    return {name: scores[name] for name in ours(truth, found, radius)}


@pytest.fixture(scope="session")
def real_people(shared_data: Path) -> Annotations:
    """200 frames of WILDTRACK, 4785 annotations, linked into people."""
    lines = frame_column_row.read(shared_data / "wildtrack" / "positions_0000-0995.txt")
    return linked(lines.frames, np.column_stack((lines.columns, lines.rows)) * 0.025)


@pytest.mark.parametrize("radius", [0.5, 1.0])
@pytest.mark.parametrize(
    "mistakes",
    [
        {},
        {"noise": 0.25, "swaps": 60},
        {"missed": 0.5, "invented": 0.4, "noise": 0.4, "swaps": 150},
        {"missed": 0.0, "invented": 0.0, "swaps": 0, "noise": 0.0, "bias": (0.0, 0.0)},
    ],
    ids=["usual", "swapped", "poor", "exact"],
)
def test_scores_of_real_people_are_trackevals(real_people: Annotations, mistakes, radius) -> None:
    found = imperfect(real_people, np.random.default_rng(7), **mistakes)
    expected = theirs(real_people, found, radius)
    assert ours(real_people, found, radius) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("radius", [0.5, 1.0])
@pytest.mark.parametrize("wobble, swap_every", [(0.0, 100), (0.2, 13), (0.35, 3)])
def test_scores_of_crossing_people_are_trackevals(wobble: float, swap_every: int, radius: float) -> None:
    scene = crossing_people(people=14, frames=60, wobble=wobble, swap_every=swap_every)
    assert ours(*scene, radius) == pytest.approx(theirs(*scene, radius), abs=1e-9)


@given(layers(), layers())
def test_identities_of_any_two_layers_are_trackevals(truth: Annotations, found: Annotations) -> None:
    assume(len(truth) and len(found))
    # No two positions are exactly this far apart: there the two differ, one counting the radius in.
    score, expected = ours(truth, found, 0.3001), theirs(truth, found, 0.3001)
    for name in ("IDF1", "ID precision", "ID recall"):
        assert score[name] == pytest.approx(expected[name], abs=1e-9)
