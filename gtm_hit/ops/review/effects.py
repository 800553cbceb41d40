"""What follows a transition, in the same transaction. Whoever wants to be told adds a line to the list."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from gtm_hit.ops.review import choosing
from gtm_hit.ops.review.happened import Following, Happened

Effect = Callable[[Happened], Following | None]

EFFECTS: list[Effect] = [choosing.after_submission]


def following(happened: Happened) -> Iterator[Following]:
    """Tell everybody; the steps the system is to take now."""
    for effect in EFFECTS:
        if found := effect(happened):
            yield found
