"""What an export holds. The same layer always gives the same bytes: no time and no machine goes into them."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from gtm_hit.formats.camera_json import save_cameras
from gtm_hit.formats.manifest import FileEntry, Manifest, write_manifest
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Dataset, Layer
from gtm_hit.ops.coverage import table
from gtm_hit.ops.export_calibrations import UNITS, calibration_files
from gtm_hit.ops.export_frames import FrameReader

ANNOTATIONS = "annotations_positions"

TABLE = "computing the rectangle table"
FRAMES = "writing frames"
Report = Callable[[str, int, int], None]  # the phase in words, steps done, steps in all


class ExportFolder:
    """Fills one empty folder with one layer."""

    def __init__(self, folder: Path, layer: Layer, report: Report) -> None:
        self.folder = folder
        self.layer = layer
        self.dataset: Dataset = layer.dataset
        self.report = report
        self.files: dict[str, FileEntry] = {}
        self.frames = self.annotations = self.not_validated = 0
        self.persons: set[int] = set()

    def write(self) -> Manifest:
        cameras = self.dataset.calibrated_cameras()
        self._write_frames(cameras)
        for name, data in calibration_files(cameras, self.dataset.rule):
            self._write(name, data)
        self._write_cameras(cameras)
        self._write("README.txt", self._readme().encode())
        manifest = Manifest(self._counts(cameras), self._parameters(), self.files)
        write_manifest(self.folder, manifest)
        return manifest

    def _write_frames(self, cameras: list[Camera]) -> None:
        rectangles = table(self.dataset, lambda done, total: self.report(TABLE, done, total))
        reader = FrameReader(self.layer, self.dataset, cameras, rectangles)
        total = reader.count()
        (self.folder / ANNOTATIONS).mkdir()
        for frame in reader:
            self._write(f"{ANNOTATIONS}/{self.dataset.annotation_name(frame.number)}", frame.json)
            self.persons.update(frame.persons)
            self.annotations += len(frame.persons)
            self.not_validated += frame.not_validated
            self.frames += 1
            # A save that arrives meanwhile may add a frame that was not counted.
            self.report(FRAMES, self.frames, max(total, self.frames))

    def _write_cameras(self, cameras: list[Camera]) -> None:
        path = self.folder / "cameras.json"
        save_cameras(path, cameras)
        self._note(path.name, path.read_bytes())

    def _write(self, name: str, data: bytes) -> None:
        path = self.folder / name
        if name not in self.files:
            path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        self._note(name, data)

    def _note(self, name: str, data: bytes) -> None:
        self.files[name] = FileEntry(len(data), hashlib.sha256(data).hexdigest())

    def _counts(self, cameras: list[Camera]) -> dict[str, int]:
        return {
            "frames": self.frames,
            "cameras": len(cameras),
            "people": len(self.persons),
            "annotations": self.annotations,
            "not_validated": self.not_validated,
        }

    def _parameters(self) -> dict[str, Any]:
        dataset = self.dataset
        return {
            "dataset": dataset.slug,
            "dataset_name": dataset.name,
            "layer": self.layer.name,
            "layer_kind": self.layer.kind,
            "grid": asdict(dataset.grid),
            "cylinder": asdict(dataset.cylinder),
            "foot_rule": dataset.rule.value,
            "frame_rate": dataset.frame_rate,
            "frame_step": dataset.frame_step,
            "annotation_offset": dataset.annotation_offset,
            "undistorted": dataset.undistorted,
            "calibration_tvec_unit": UNITS[dataset.rule],
        }

    def _readme(self) -> str:
        grid, cylinder = self.dataset.grid, self.dataset.cylinder
        return README.format(
            dataset=self.dataset.name,
            layer=self.layer.name,
            columns=grid.columns,
            rows=grid.rows,
            step=grid.step,
            origin_x=grid.origin_x,
            origin_y=grid.origin_y,
            radius=cylinder.radius,
            height=cylinder.height,
            unit={"cm": "centimetres", "m": "metres"}[UNITS[self.dataset.rule]],
            offset=self.dataset.annotation_offset,
            annotations=ANNOTATIONS,
        )


README = """\
{dataset}: layer {layer}

{annotations}/   one JSON file per frame: a list of people, each with
    personID      the same person has the same number in all frames
    positionID    row * {columns} + column on the ground grid
    views         one rectangle per camera in pixels, all four -1 where the person is not visible
    x, y          the same position in metres
    height, radius  of this person in metres, where they are not the usual ones
    origin        how the position came about
    validated     false where nobody confirmed a position that was carried over
  The number in a file name is the frame number plus {offset}.

Grid: {columns} x {rows} positions, {step} m apart, the first at ({origin_x}, {origin_y}) m.
A person is a cylinder of {radius} m radius and {height} m height standing on a position.

calibrations/   OpenCV XML per camera; tvec in {unit}
cameras.json    the same numbers in one file; tvec in metres
manifest.json   counts, parameters, and the SHA-256 of every file
"""
