"""A layer's annotations in metres, some frames at a time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gtm_hit.models import Annotation, Layer
from gtm_hit.ops.frames.row import FIELDS, Row
from gtm_hit.ops.gold.withdraw import without_faults


@dataclass(frozen=True)
class PlacedRow:
    frame: int  # its number
    row: Row
    x: float  # metres
    y: float

    def as_dict(self) -> dict[str, Any]:
        return {"frame": self.frame, **self.row.as_dict(), "x": self.x, "y": self.y}


def placed(layer: Layer, start: int, end: int, frames: int) -> tuple[list[PlacedRow], int | None]:
    """Annotations of the first `frames` frames numbered start to end, and where to go on.

    Frames are chosen by number and annotations by frame: it costs the same anywhere in a long layer.
    """
    wanted = layer.dataset.frames.filter(number__gte=start, number__lte=end).order_by("number")
    number_of = dict(wanted.values_list("pk", "number")[: frames + 1])
    following = number_of.popitem()[1] if len(number_of) > frames else None
    rows = Annotation.objects.filter(layer=layer, frame__in=list(number_of)).order_by()
    honest = without_faults(layer)
    kept = [(frame, Row(*values)) for frame, *values in rows.values_list("frame_id", *FIELDS)]
    kept = [(frame, row) for frame, row in kept if frame not in honest]
    kept += [(frame, row) for frame in number_of.keys() & honest.keys() for row in honest[frame]]
    # No two rows share frame and person.
    people = sorted(((number_of[frame], row) for frame, row in kept), key=lambda one: (one[0], one[1].person))
    metres = layer.dataset.grid.metres([row.position for _number, row in people]).round(6).tolist()
    together = zip(people, metres, strict=True)
    return [PlacedRow(number, row, x, y) for (number, row), (x, y) in together], following
