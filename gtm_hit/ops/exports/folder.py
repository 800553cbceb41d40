"""What an export holds. The same layer always gives the same bytes: no time and no machine goes into them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Any

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.formats.manifest import Manifest, write_manifest
from gtm_hit.formats.stable_zip import StableZip
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Annotation, Dataset, Layer
from gtm_hit.ops.calibration.versions import cameras_in, in_place
from gtm_hit.ops.exports.calibrations import UNITS
from gtm_hit.ops.exports.files import ExportFiles
from gtm_hit.ops.exports.formats.registry import DEFAULT_FORMATS, FORMATS
from gtm_hit.ops.exports.formats.target import Target, Writer
from gtm_hit.ops.exports.frames import Chunk, FrameReader
from gtm_hit.ops.exports.sources import SourcesWriter
from gtm_hit.ops.ground.coverage import table
from gtm_hit.ops.jobs.progress import Progress
from gtm_hit.ops.stitching.provenance import is_stitched, source_layers

TABLE = "computing the rectangle table"
FRAMES = "writing frames"


class ExportFolder:
    """Fills an empty folder and an archive with a layer in the chosen formats; `more` are further writers."""

    def __init__(
        self,
        folder: Path,
        archive: StableZip,
        layer: Layer,
        report: Progress,
        formats: Collection[str] = DEFAULT_FORMATS,
        more: Sequence[Callable[[Target], Writer]] = (),
    ) -> None:
        self.layer = layer
        self.dataset: Dataset = layer.dataset
        self.report = report
        self.formats = list(formats)
        self.stitched = is_stitched(layer)
        sources = [SourcesWriter] if self.stitched else []
        self.writers = [*(FORMATS[name].writer for name in formats), *sources, *more]
        self.files = ExportFiles(folder, archive)
        self.frames = self.annotations = self.not_validated = 0
        self.persons: set[int] = set()

    def write(self) -> Manifest:
        self.write_layer()
        self.files.write("README.txt", self.readme().encode())
        return self.seal()

    def write_layer(self) -> None:
        """Everything the formats hold."""
        # One reading for everything: the calibration may be replaced while this goes on.
        self.calibration = in_place(self.dataset)
        self.cameras = cameras_in(self.calibration) if self.calibration else self.dataset.calibrated_cameras()
        rectangles = table(self.dataset, lambda done, total: self.report(TABLE, done, total), self.cameras)
        with ExitStack() as open_files:
            target = Target(self.files, self.layer, self.cameras, rectangles, self.report, open_files)
            writers = [make(target) for make in self.writers]
            reader = FrameReader(self.layer, self.dataset, self.cameras, rectangles)
            total = reader.count()
            self.report(FRAMES, 0, total)
            for chunk in reader:
                self._add(chunk, writers, total)
            for writer in writers:
                writer.finish()
        save_cameras(self.files.path("cameras.json"), self.cameras)
        self.files.note("cameras.json")

    def seal(self, **parameters: Any) -> Manifest:
        """The manifest of what was written so far; the last file."""
        manifest = Manifest(
            self._counts(self.cameras), {**self._parameters(), **parameters}, self.files.entries
        )
        path = write_manifest(self.files.folder, manifest)
        self.files.archive.add(path.name, path)
        return manifest

    def _add(self, chunk: Chunk, writers: list[Writer], total: int) -> None:
        for writer in writers:
            writer.add(chunk)
        self.persons.update(chunk.persons.tolist())
        self.annotations += len(chunk.persons)
        self.not_validated += sum(state != Annotation.State.VALIDATED for state in chunk.states)
        self.frames += len(chunk.numbers)
        # A save that arrives meanwhile may add a frame that was not counted.
        self.report(FRAMES, self.frames, max(total, self.frames))

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
        stitched = {"sources": [asdict(each) for each in source_layers(self.layer)]} if self.stitched else {}
        return {
            **stitched,
            "dataset": dataset.slug,
            "dataset_name": dataset.name,
            "layer": self.layer.name,
            "layer_kind": self.layer.kind,
            "formats": self.formats,
            "grid": asdict(dataset.grid),
            "cylinder": asdict(dataset.cylinder),
            "foot_rule": dataset.rule.value,
            "frame_rate": dataset.frame_rate,
            "frame_step": dataset.frame_step,
            "annotation_offset": dataset.annotation_offset,
            "undistorted": dataset.undistorted,
            "calibration": self.calibration.number if self.calibration else None,
            "calibration_tvec_unit": UNITS[dataset.rule],
        }

    def readme(self) -> str:
        grid, cylinder = self.dataset.grid, self.dataset.cylinder
        values = {
            "dataset": self.dataset.name,
            "layer": self.layer.name,
            "columns": grid.columns,
            "rows": grid.rows,
            "step": grid.step,
            "origin_x": grid.origin_x,
            "origin_y": grid.origin_y,
            "radius": cylinder.radius,
            "height": cylinder.height,
            "unit": {"cm": "centimetres", "m": "metres"}[UNITS[self.dataset.rule]],
            "offset": self.dataset.annotation_offset,
        }
        parts = [FORMATS[name].readme.format(**values) for name in self.formats]
        if self.stitched:
            parts.append(STITCHED)
        return README.format(**values, formats="\n".join(parts))


STITCHED = """\
sources.csv   of which workers' annotations each person of each frame was made; their layers: manifest.json
"""

README = """\
{dataset}: layer {layer}

{formats}
Grid: {columns} x {rows} positions, {step} m apart, the first at ({origin_x}, {origin_y}) m.
A person is a cylinder of {radius} m radius and {height} m height standing on a position.

cameras.json    the calibration; tvec in metres
manifest.json   counts, parameters, and the SHA-256 of every file
"""
