"""A long layer is opened in parts: the images of an hour's frames alone would be an answer of 50 MB."""

from __future__ import annotations

from dataclasses import dataclass

from django.db.models import Exists, OuterRef

from gtm_hit.models import Layer, LayerFrame

FRAMES_PER_PART = 500


@dataclass(frozen=True)
class Part:
    """Consecutive frames by their numbers, both included. Parts of a layer do not overlap."""

    first: int
    last: int


def is_long(frames: int) -> bool:
    return frames > FRAMES_PER_PART


def part_of(layer: Layer, number: int | None = None) -> Part | None:
    """The part with a frame number, by default with the first frame that is not done.

    None for a layer that is opened whole: of a short dataset, or of an assignment.
    """
    frames = layer.dataset.frames.order_by("number").values_list("number", flat=True)
    count = frames.count()
    if not is_long(count) or layer.kind == Layer.Kind.ASSIGNMENT:
        return None
    if number is None:
        done = LayerFrame.objects.filter(layer=layer, frame=OuterRef("pk"), done=True)
        number = frames.filter(~Exists(done)).first() or 0
    index = min(frames.filter(number__lt=number).count(), count - 1) // FRAMES_PER_PART
    together = list(frames[index * FRAMES_PER_PART : (index + 1) * FRAMES_PER_PART])
    return Part(together[0], together[-1])
