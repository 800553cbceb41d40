"""Who made every annotation of a release, by pseudonym: workers' real ids never leave the server."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter
from pathlib import Path

from django.db.models import F

from gtm_hit.models import Annotation, Assignment, Layer, LayerFrame, Save
from gtm_hit.ops.exports.formats.target import Target
from gtm_hit.ops.exports.frames import Chunk
from gtm_hit.ops.stitching import provenance as stitching

PROVENANCE = "provenance.csv"
COLUMNS = ("frame", "person", "x", "y", "worker", "origin", "state", "seconds")
STAFF = "staff"  # somebody with a login; accounts have names of people

Author = tuple[str, float]  # pseudonym, active seconds per person of the frame


class ProvenanceWriter:
    """A line per annotation. `seconds` is the frame's active time shared by the people in it."""

    def __init__(self, target: Target) -> None:
        self.layer = target.layer
        self.stitched = stitching.is_stitched(target.layer)
        self.stream = target.open_files.enter_context(target.files.stream(PROVENANCE))
        self._write([COLUMNS])

    def add(self, chunk: Chunk) -> None:
        authors = _authors(self.layer, chunk)
        by_person = stitching.authors(self.layer, chunk.numbers) if self.stitched else {}
        # A layer somebody made elsewhere of accepted work: told by where people stand.
        placed = self.layer.kind == Layer.Kind.GROUND_TRUTH and not self.stitched
        by_place = _accepted(self.layer, chunk) if placed else {}
        columns = zip(
            chunk.frames.tolist(),
            chunk.persons.tolist(),
            chunk.positions.tolist(),
            chunk.xy.tolist(),
            chunk.origins,
            chunk.states,
            strict=True,
        )
        lines: list[tuple[object, ...]] = []
        for frame, person, position, (x, y), origin, state in columns:
            # Staff stitches the layer together, but the worker who put the person there made the annotation.
            made = by_person.get((frame, person)) or by_place.get((frame, position))
            worker, seconds = made or authors.get(frame, ("", 0.0))
            lines.append((frame, person, x, y, worker, origin, state, round(seconds, 3)))
        self._write(lines)

    def finish(self) -> None:
        pass

    def _write(self, lines: Sequence[tuple[object, ...]]) -> None:
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(lines)
        self.stream.write(text.getvalue().encode())


@dataclass(frozen=True)
class Line:
    """What changes between releases are told by."""

    frame: int
    person: int
    x: float
    y: float


def read_lines(path: Path) -> Iterator[tuple[int, dict[int, Line]]]:
    """Frames in order, the people of each by number; one frame in memory at a time."""
    with path.open(newline="", encoding="utf-8") as stream:
        lines = (
            Line(int(row["frame"]), int(row["person"]), float(row["x"]), float(row["y"]))
            for row in csv.DictReader(stream)
        )
        for frame, people in groupby(lines, key=attrgetter("frame")):
            yield frame, {line.person: line for line in people}


def _authors(layer: Layer, chunk: Chunk) -> dict[int, Author]:
    """By frame number: whoever saved the newest revision."""
    saves = Save.objects.filter(
        layer_frame__layer=layer,
        layer_frame__frame__number__in=chunk.numbers,
        revision=F("layer_frame__revision"),
    ).values_list("layer_frame__frame__number", "worker__pseudonym", "user_id", "layer_frame__seconds")
    people = Counter(chunk.frames.tolist())
    return {
        number: (pseudonym or (STAFF if user else ""), seconds / max(people[number], 1))
        for number, pseudonym, user, seconds in saves
    }


def _accepted(layer: Layer, chunk: Chunk) -> dict[tuple[int, int], Author]:
    """By frame number and position: workers whose accepted assignments have somebody there."""
    frames = {"frame__dataset": layer.dataset, "frame__number__in": chunk.numbers}
    accepted = Assignment.objects.filter(
        state=Assignment.State.ACCEPTED,
        batch__dataset=layer.dataset,
        batch__frames__number__in=chunk.numbers,
    )
    pseudonyms = dict(accepted.values_list("layer_id", "worker__pseudonym").distinct())
    heads = LayerFrame.objects.filter(layer__in=pseudonyms, **frames)
    seconds = {
        (layer_id, number): spent
        for layer_id, number, spent in heads.values_list("layer_id", "frame__number", "seconds")
    }
    found = list(
        Annotation.objects.filter(layer__in=pseudonyms, **frames)
        .order_by("layer_id")
        .values_list("layer_id", "frame__number", "position")
    )
    people = Counter((layer_id, number) for layer_id, number, _ in found)
    return {
        (number, position): (
            pseudonyms[layer_id],
            seconds.get((layer_id, number), 0.0) / people[layer_id, number],
        )
        for layer_id, number, position in found
    }
