"""The layouts in which the two data sets of the field are published, and their tables of rectangles."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from gtm_hit.formats.annotations.wildtrack_json import extra_text, joined, person_texts
from gtm_hit.formats.pom import PomHeader, write_pom
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.models import Annotation
from gtm_hit.ops.exports.calibrations import calibration_files
from gtm_hit.ops.exports.formats.target import RECTANGLES, Target
from gtm_hit.ops.exports.frames import Chunk

ANNOTATIONS = "annotations_positions"
MULTIVIEWX = "multiviewx/"
MULTIVIEWX_DIGITS = 5


class WildtrackWriter:
    """One JSON file per frame, and the calibration as readers of the dataset's foot rule look for it."""

    def __init__(self, target: Target) -> None:
        self.target = target
        for name, data in calibration_files(target.cameras, target.dataset.rule):
            target.files.write(name, data)

    def add(self, chunk: Chunk) -> None:
        for number, data in frames_json(chunk):
            self.target.files.write(f"{ANNOTATIONS}/{self.target.dataset.annotation_name(number)}", data)

    def finish(self) -> None:
        pass


class MultiviewxWriter:
    """The same in a folder of its own, named and numbered as MultiviewX is, with its table of rectangles."""

    def __init__(self, target: Target) -> None:
        self.target = target
        for name, data in calibration_files(target.cameras, FootRule.CENTRE, "intrinsic"):
            target.files.write(MULTIVIEWX + name, data)

    def add(self, chunk: Chunk) -> None:
        offset = self.target.dataset.annotation_offset
        for number, data in frames_json(chunk):
            name = f"{number + offset:0{MULTIVIEWX_DIGITS}d}.json"
            self.target.files.write(f"{MULTIVIEWX}{ANNOTATIONS}/{name}", data)

    def finish(self) -> None:
        write_rectangles(self.target, f"{MULTIVIEWX}rectangles.pom", headed=False)


class PomWriter:
    """The rectangles of all positions, whoever stands there."""

    def __init__(self, target: Target) -> None:
        self.target = target

    def add(self, chunk: Chunk) -> None:
        pass

    def finish(self) -> None:
        write_rectangles(self.target, "rectangles.pom", headed=True)


def write_rectangles(target: Target, name: str, headed: bool) -> None:
    dataset = target.dataset
    header = PomHeader(dataset.grid, dataset.cylinder, len(target.cameras))

    def tell(done: int, total: int) -> None:
        target.report(RECTANGLES, done, total)

    write_pom(target.files.path(name), header, target.table, tell, headed)
    target.files.note(name)


def frames_json(chunk: Chunk) -> list[tuple[int, bytes]]:
    """Frame numbers and the bytes of their files."""
    shown = np.where(chunk.visible[:, :, None], chunk.boxes, np.int16(-1))
    people = person_texts(chunk.persons, chunk.positions, shown, _extras(chunk))
    return [(number, joined(people[rows])) for number, rows in chunk.by_frame()]


def _extras(chunk: Chunk) -> Iterator[str]:
    """What follows the published keys of a person: metres, an own size, where the position came from."""
    columns = zip(
        chunk.xy.tolist(),
        chunk.heights.tolist(),
        chunk.radii.tolist(),
        chunk.states,
        chunk.origins,
        strict=True,
    )
    validated = str(Annotation.State.VALIDATED)
    for (x, y), height, radius, state, origin in columns:
        # NaN is the only number that differs from itself.
        sizes = [size for size in (height, radius) if size == size]
        yield _extra(height == height, radius == radius, origin, state == validated) % (x, y, *sizes)


@cache
def _extra(height: bool, radius: bool, origin: str, validated: bool) -> str:
    """With `%r` for every number; of the same keys there are few kinds and very many people."""
    keys: dict[str, object] = {"x": "%r", "y": "%r"}
    if height:
        keys["height"] = "%r"
    if radius:
        keys["radius"] = "%r"
    keys["origin"] = origin
    if not validated:
        keys["validated"] = False
    return extra_text(keys).replace('"%r"', "%r")
