"""The layouts in which the two data sets of the field are published, and their tables of rectangles."""

from __future__ import annotations

from typing import Any

import numpy as np

from gtm_hit.formats.pom import PomHeader, write_pom
from gtm_hit.formats.wildtrack_json import PersonPosition, frame_json
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.models import Annotation
from gtm_hit.ops.export_calibrations import calibration_files
from gtm_hit.ops.export_formats.target import RECTANGLES, Target
from gtm_hit.ops.export_frames import Chunk

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
    columns = zip(chunk.persons.tolist(), chunk.positions.tolist(), shown, _extras(chunk), strict=True)
    people = [PersonPosition(*values) for values in columns]
    cameras = chunk.boxes.shape[1]
    return [(number, frame_json(people[rows], cameras)) for number, rows in chunk.by_frame()]


def _extras(chunk: Chunk) -> list[dict[str, Any]]:
    """What follows the published keys of a person: metres, an own size, where the position came from."""
    columns = zip(
        chunk.xy.tolist(),
        chunk.heights.tolist(),
        chunk.radii.tolist(),
        chunk.states,
        chunk.origins,
        strict=True,
    )
    return [_extra(*values) for values in columns]


def _extra(xy: list[float], height: float, radius: float, state: str, origin: str) -> dict[str, Any]:
    keys: dict[str, Any] = {"x": xy[0], "y": xy[1]}
    # NaN is the only number that differs from itself.
    if height == height:
        keys["height"] = height
    if radius == radius:
        keys["radius"] = radius
    keys["origin"] = origin
    if state != Annotation.State.VALIDATED:
        keys["validated"] = False
    return keys
