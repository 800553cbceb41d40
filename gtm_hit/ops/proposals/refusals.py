"""Places where somebody looked and found nobody."""

from __future__ import annotations

from collections.abc import Iterable

from django.contrib.auth.models import AbstractBaseUser
from django.db import transaction

from gtm_hit.models import Frame, Layer, Refusal, Worker
from gtm_hit.ops.frames.saving import Author
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.work import leases

NEAR = 0.35  # metres: proposals this close to a refused place are of the same nobody
MOST = 2000  # of one frame


def refuse(layer: Layer, frame: Frame, position: int, author: Author, refused: bool = True) -> None:
    """Remember that nobody is there, or forget it; again: nothing changes.

    Of workers only the layer's own may, while they hold the batch: else ReadOnly is raised.
    """
    if not 0 <= position < layer.dataset.grid.count:
        raise ProposalError(f"position {position} is not on the grid")
    with transaction.atomic():
        if isinstance(author, Worker):
            leases.require_editable(layer, leases.locked_for_layer(layer), author)
        there = Refusal.objects.filter(layer=layer, frame=frame)
        if not refused:
            there.filter(position=position).delete()
            return
        if there.count() >= MOST:
            raise ProposalError(f"more than {MOST} refusals in one frame")
        Refusal.objects.get_or_create(layer=layer, frame=frame, position=position, defaults=_by(author))


def _by(author: Author) -> dict[str, object]:
    if isinstance(author, Worker):
        return {"worker": author}
    return {"user": author if isinstance(author, AbstractBaseUser) else None}


def refused_in(layer: Layer, frames: Iterable[int]) -> dict[int, list[int]]:
    """Positions by frame id."""
    found: dict[int, list[int]] = {}
    rows = Refusal.objects.filter(layer=layer, frame__in=list(frames)).order_by("frame", "position")
    for frame, position in rows.values_list("frame_id", "position"):
        found.setdefault(frame, []).append(position)
    return found
