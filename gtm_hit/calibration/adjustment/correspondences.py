"""Points that several cameras saw, out of the feet and heads that were clicked picture by picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.problem import Sightings
from gtm_hit.formats.calibration.pos_file import PosFile

PARTS = ("feet", "head")


@dataclass(frozen=True, eq=False)
class Correspondences:
    """Free points of a `Problem`: their places are not known yet, so its `points` are NaN."""

    names: tuple[tuple[str, str, str], ...]  # (P,) frame, identity, feet or head
    seen: Sightings
    feet: NDArray[np.bool_]  # (P,)

    @property
    def points(self) -> NDArray[np.float64]:
        return np.full((len(self.names), 3), np.nan)


def correspondences(cameras: Sequence[str], files: Mapping[tuple[str, str], PosFile]) -> Correspondences:
    """Of files by camera and frame; the same identity in the same frame is the same person."""
    clicks = [
        (frame, person.name, part, cameras.index(camera), pixel)
        for (camera, frame), file in sorted(files.items())
        for person in file.people
        for part, pixel in zip(PARTS, (person.feet, person.head), strict=True)
        if pixel is not None
    ]
    names = sorted({click[:3] for click in clicks})
    places = {name: place for place, name in enumerate(names)}
    return Correspondences(
        tuple(names),
        Sightings(
            np.array([click[3] for click in clicks], dtype=np.int64),
            np.array([places[click[:3]] for click in clicks], dtype=np.int64),
            np.array([click[4] for click in clicks], dtype=np.float64).reshape(-1, 2),
        ),
        np.array([part == PARTS[0] for _, _, part in names], dtype=bool),
    )
