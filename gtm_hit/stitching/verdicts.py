"""What people decided about pairs, found again by the annotations both sides were made of."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass

import numpy as np

from gtm_hit.stitching.tracks import Floats, Source


@dataclass(frozen=True)
class Verdict:
    before: frozenset[Source]
    after: frozenset[Source]
    same: bool


class Verdicts:
    """Looked up by any one source of each side: a side may have got another replica meanwhile."""

    def __init__(self, verdicts: Iterable[Verdict] = ()) -> None:
        self._said: dict[tuple[Source, Source], bool] = {}
        for verdict in verdicts:
            for one in verdict.before:
                for other in verdict.after:
                    self._said[one, other] = verdict.same
        self._known = {source for pair in self._said for source in pair}

    def between(self, before: Sequence[Set[Source]], after: Sequence[Set[Source]]) -> Floats:
        """(N, M): 1 for the same person, -1 for two, 0 where nobody said anything."""
        said = np.zeros((len(before), len(after)))
        known = [self._known & sources for sources in after]
        for row, sources in enumerate(before):
            for column, others in enumerate(known):
                if others:
                    said[row, column] = self.of(sources & self._known, others)
        return said

    def of(self, before: Set[Source], after: Set[Source]) -> int:
        found = [
            self._said[pair] for one in before for other in after if (pair := (one, other)) in self._said
        ]
        return 0 if not found else 1 if sum(found) * 2 > len(found) else -1
