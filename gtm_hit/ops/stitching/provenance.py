"""From which annotations of which workers a stitched layer's people were made."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from django.db.models import F

from gtm_hit.models import Annotation, Assignment, Layer, LayerFrame, StitchedFrame, Stitching
from gtm_hit.ops.stitching.numbering import pairs
from gtm_hit.ops.stitching.scope import Scope


@dataclass(frozen=True)
class SourceLine:
    """One annotation that went into another one."""

    frame: int  # number
    person: int  # in the stitched layer
    layer: str
    layer_id: int
    source_person: int  # in that layer
    worker: str  # pseudonym
    batch: int
    copy: int


@dataclass(frozen=True)
class SourceLayer:
    layer: str
    worker: str  # pseudonym
    batch: int
    copy: int


def is_stitched(layer: Layer) -> bool:
    return Stitching.objects.filter(layer=layer).exists()


def source_layers(layer: Layer) -> list[SourceLayer]:
    """Of all that is accepted now, by batch."""
    stitching = Stitching.objects.select_related("dataset", "campaign").get(layer=layer)
    accepted = Scope(stitching.dataset, stitching.campaign).accepted()
    rows = accepted.values_list("layer__name", "worker__pseudonym", "batch__number", "batch__copy")
    return [SourceLayer(*row) for row in rows]


def lines(layer: Layer, numbers: Collection[int]) -> Iterator[SourceLine]:
    """By frame and person, of frames nobody has changed by hand since."""
    frames = StitchedFrame.objects.filter(layer=layer, frame__number__in=numbers)
    untouched = frames.filter(frame__layer_frames__layer=layer, frame__layer_frames__revision=F("revision"))
    kept = list(untouched.order_by("frame__number").values_list("frame__number", "sources"))
    layers = {source for _, people in kept for _, *flat in people for source, _ in pairs(flat)}
    known = _layers(layers)
    for number, people in kept:
        for person, *flat in people:
            for source, source_person in pairs(flat):
                name, worker, batch, copy = known[source]
                yield SourceLine(number, person, name, source, source_person, worker, batch, copy)


def authors(layer: Layer, numbers: Collection[int]) -> dict[tuple[int, int], tuple[str, float]]:
    """By frame number and person: the workers, and their active seconds that went into it."""
    found = list(lines(layer, numbers))
    layers = {line.layer_id for line in found}
    heads = LayerFrame.objects.filter(layer__in=layers, frame__number__in=numbers)
    seconds = {
        (owner, number): spent
        for owner, number, spent in heads.values_list("layer_id", "frame__number", "seconds")
    }
    rows = Annotation.objects.filter(layer__in=layers, frame__number__in=numbers).order_by()
    people = Counter(rows.values_list("layer_id", "frame__number"))
    made: dict[tuple[int, int], tuple[str, float]] = {}
    for line in found:
        workers, spent = made.get((line.frame, line.person), ("", 0.0))
        source = line.layer_id, line.frame
        names = workers if line.worker in workers.split() else f"{workers} {line.worker}".strip()
        made[line.frame, line.person] = names, spent + seconds.get(source, 0.0) / max(people[source], 1)
    return made


def _layers(ids: Collection[int]) -> Mapping[int, tuple[str, str, int, int]]:
    rows = Assignment.objects.filter(layer__in=ids)
    columns = ("worker__pseudonym", "batch__number", "batch__copy")
    found = {pk: tuple(rest) for pk, *rest in rows.values_list("layer_id", "layer__name", *columns)}
    # What a reviewer put right himself is a layer of its own.
    mended = Assignment.objects.filter(mend__layer__in=ids)
    for pk, *rest in mended.values_list("mend__layer_id", "mend__layer__name", *columns):
        found[pk] = tuple(rest)
    return found
