"""Formats of trackers and detectors: boxes in every view, and people on the ground."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gtm_hit.formats.annotations import csv_metres, frame_column_row
from gtm_hit.formats.annotations.coco import CocoBox, CocoImage, CocoWriter
from gtm_hit.formats.annotations.mot import MotTable, mot_lines, places_of, seqinfo
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.ops.exports.formats.target import Target
from gtm_hit.ops.exports.frames import Chunk

IMAGE_DIGITS = {FootRule.CORNERS: 8, FootRule.CENTRE: 4}  # in the names of the published images


class MotViewsWriter:
    """MOTChallenge: a sequence per view, and one of people on the ground."""

    def __init__(self, target: Target) -> None:
        self.target = target
        self.places = places_of(target.numbers)
        opened = target.open_files.enter_context
        self.views = [
            opened(target.files.stream(f"mot/{camera.name}/gt/gt.txt")) for camera in target.cameras
        ]
        self.ground = opened(target.files.stream("mot/ground/gt/gt.txt"))
        # Numbers between annotated frames are no frames of the sequence.
        rate = 1 / target.dataset.seconds_per_frame
        for camera in target.cameras:
            data = seqinfo(camera.name, len(target.numbers), rate, camera.width, camera.height, ".png")
            target.files.write(f"mot/{camera.name}/seqinfo.ini", data)

    def add(self, chunk: Chunk) -> None:
        for number, stream in enumerate(self.views):
            rows = np.flatnonzero(chunk.visible[:, number])
            boxes = chunk.boxes[rows, number].astype(np.float64)
            table = MotTable(chunk.frames[rows], chunk.persons[rows], boxes, np.ones(len(rows)))
            stream.write(mot_lines(table, self.places))
        world = np.column_stack((chunk.xy, np.zeros(len(chunk.frames))))
        everybody = MotTable(chunk.frames, chunk.persons, None, np.ones(len(world)), world)
        self.ground.write(mot_lines(everybody, self.places))

    def finish(self) -> None:
        pass


class CocoViewsWriter:
    """COCO: a file per view, boxes with the people they belong to."""

    def __init__(self, target: Target) -> None:
        self.target = target
        self.digits = IMAGE_DIGITS[target.dataset.rule]
        opened = target.open_files.enter_context
        streams = [opened(target.files.stream(f"coco/{camera.name}.json")) for camera in target.cameras]
        self.writers = [CocoWriter(stream) for stream in streams]
        self.boxes = [0] * len(streams)
        self.numbers: list[int] = []

    def add(self, chunk: Chunk) -> None:
        places = {number: len(self.numbers) + index for index, number in enumerate(chunk.numbers, start=1)}
        self.numbers += chunk.numbers
        images = [places[number] for number in chunk.frames.tolist()]
        persons, positions = chunk.persons.tolist(), chunk.positions.tolist()
        for camera, writer in enumerate(self.writers):
            rows = np.flatnonzero(chunk.visible[:, camera]).tolist()
            boxes = chunk.boxes[:, camera].tolist()
            first = self.boxes[camera] + 1
            writer.boxes(
                CocoBox(number, images[row], tuple(boxes[row]), persons[row], positions[row])
                for number, row in enumerate(rows, start=first)
            )
            self.boxes[camera] += len(rows)

    def finish(self) -> None:
        for camera, writer in zip(self.target.cameras, self.writers, strict=True):
            writer.finish(self._images(camera))

    def _images(self, camera: Camera) -> Iterator[CocoImage]:
        for number, frame in enumerate(self.numbers, start=1):
            name = f"Image_subsets/{camera.name}/{frame:0{self.digits}d}.png"
            yield CocoImage(number, name, camera.width, camera.height, frame, camera.index)


class CsvWriter:
    """People on the ground in metres."""

    def __init__(self, target: Target) -> None:
        self.stream = target.open_files.enter_context(target.files.stream("people.csv"))
        self.stream.write(csv_metres.csv_header(heights=True))

    def add(self, chunk: Chunk) -> None:
        points = csv_metres.GroundPoints(chunk.frames, chunk.xy, chunk.persons, chunk.heights)
        self.stream.write(csv_metres.csv_lines(points, heights=True))

    def finish(self) -> None:
        pass


class TextWriter:
    """`frame column row`: people some camera sees, as MVDet's evaluation counts them, and everybody."""

    def __init__(self, target: Target) -> None:
        self.columns = target.dataset.columns
        opened = target.open_files.enter_context
        self.seen = opened(target.files.stream("frame_column_row/gt.txt"))
        self.everybody = opened(target.files.stream("frame_column_row/people.txt"))

    def add(self, chunk: Chunk) -> None:
        rows, columns = np.divmod(chunk.positions, self.columns)
        people = frame_column_row.FrameColumnRow(chunk.frames, columns, rows, chunk.persons)
        self.everybody.write(frame_column_row.lines(people))
        seen = chunk.visible.any(axis=1)
        points = frame_column_row.FrameColumnRow(chunk.frames[seen], columns[seen], rows[seen])
        self.seen.write(frame_column_row.lines(points))

    def finish(self) -> None:
        pass
