"""Looking for a board in all pictures of a source."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from gtm_hit.calibration.boards import Board
from gtm_hit.calibration.detection import find_board
from gtm_hit.calibration.views import BoardView, NotFound, Picture

EXPLAINED = 12  # pictures: asking what else might be in them takes longer than looking for the board

Progress = Callable[[int], object]  # called with the number of pictures looked at


@dataclass(frozen=True)
class Searched:
    views: tuple[BoardView, ...]
    missing: tuple[NotFound, ...]

    @property
    def other(self) -> tuple[int, int] | None:
        """Columns × rows that fit more pictures than the board asked for."""
        fits = Counter(each.other for each in self.missing if each.other)
        if not fits:
            return None
        size, count = min(fits.items(), key=lambda item: (-item[1], item[0]))
        return size if count > len(self.views) else None

    def by_reason(self) -> list[tuple[str, list[str]]]:
        """Names of the pictures without a board by what was the matter; the most frequent first."""
        names: dict[str, list[str]] = {}
        for each in self.missing:
            names.setdefault(each.reason, []).append(each.name)
        return sorted(names.items(), key=lambda item: -len(item[1]))


def search(
    pictures: Iterable[Picture | NotFound], board: Board, progress: Progress | None = None
) -> Searched:
    """The board in every picture; for those without it why, the first few of them thoroughly."""
    views: list[BoardView] = []
    missing: list[NotFound] = []
    for number, picture in enumerate(pictures, start=1):
        explain = len(missing) < EXPLAINED
        found = find_board(picture, board, explain) if isinstance(picture, Picture) else picture
        if isinstance(found, BoardView):
            views.append(found)
        else:
            missing.append(found)
        if progress:
            progress(number)
    return Searched(tuple(views), tuple(missing))
