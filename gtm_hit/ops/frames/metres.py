"""A layer's annotations in metres, some frames at a time."""

from __future__ import annotations

from typing import Any

from gtm_hit.models import Annotation, Layer

FIELDS = ("person", "position", "state", "origin", "height", "radius")


def placed(layer: Layer, start: int, end: int, frames: int) -> tuple[list[dict[str, Any]], int | None]:
    """Annotations of the first `frames` frames numbered start to end, and where to go on.

    Frames are chosen by number and annotations by frame: it costs the same anywhere in a long layer.
    """
    wanted = layer.dataset.frames.filter(number__gte=start, number__lte=end).order_by("number")
    number_of = dict(wanted.values_list("pk", "number")[: frames + 1])
    following = number_of.popitem()[1] if len(number_of) > frames else None
    rows = Annotation.objects.filter(layer=layer, frame__in=list(number_of)).order_by()
    found = [
        {"frame": number_of[frame], **dict(zip(FIELDS, values, strict=True))}
        for frame, *values in rows.values_list("frame_id", *FIELDS)
    ]
    found.sort(key=lambda row: (row["frame"], row["person"]))
    metres = layer.dataset.grid.metres([row["position"] for row in found]).round(6).tolist()
    for row, (x, y) in zip(found, metres, strict=True):
        row.update(x=x, y=y)
    return found, following
