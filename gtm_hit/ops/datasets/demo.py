"""The demo scene: rendered into a folder in the published layout, then imported like any other dataset."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from django.conf import settings

from gtm_hit.demo.render import Truth, render_scene
from gtm_hit.demo.scene import Scene, SceneError, read_scene
from gtm_hit.formats.annotations.wildtrack_json import (
    FrameAnnotations,
    PersonPosition,
    write_frame,
)
from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.formats.calibration.wildtrack_xml import (
    Extrinsic,
    Intrinsic,
    Style,
    extrinsic_xml,
    intrinsic_xml,
)
from gtm_hit.formats.files import write_bytes
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.models import Campaign, Dataset, Layer
from gtm_hit.ops.campaigns import editing, states
from gtm_hit.ops.datasets.importing import import_dataset
from gtm_hit.ops.datasets.options import PRESETS, ImportOptions, SceneValues
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.jobs.progress import Progress, no_progress
from gtm_hit.ops.work.batches import make_batches

CAMERAS = settings.BASE_DIR / "fixtures" / "wildtrack_cameras.json"
TRUTH = "truth"
MOST_FRAMES = 1000


CAMPAIGN = "team"


class DemoError(OperationError, ValueError):
    """A demo scene that cannot be made; says why."""


@dataclass(frozen=True)
class Demo:
    dataset: Dataset
    frames_added: int


def make_demo(
    slug: str = "demo", frames: int | None = None, seed: int | None = None, progress: Progress = no_progress
) -> Demo:
    """Render and import the scene, its truth into a hidden layer, and cut it into batches.

    A demo scene that is there already stays as it is and only gets the batches it lacks. Raises DemoError,
    and ImportFailed like any import.
    """
    if frames is not None and not 1 <= frames <= MOST_FRAMES:
        raise DemoError(f"A demo scene has 1 to {MOST_FRAMES} frames, not {frames}.")
    dataset = Dataset.objects.filter(slug=slug).first()
    added = 0
    if dataset is None:
        scene = read_scene()
        scene = replace(
            scene,
            frame_count=scene.frame_count if frames is None else frames,
            seed=scene.seed if seed is None else seed,
        )
        dataset = _make(slug, scene, progress)
        added = scene.frame_count
    elif not Layer.objects.filter(dataset=dataset, name=TRUTH, hidden=True).exists():
        raise DemoError(f"Dataset {slug} is there already and is no demo scene.")
    make_batches(dataset)
    return Demo(dataset, added)


def open_campaign(demo: Demo) -> Campaign:
    """The demo scene's own campaign, for whoever has an account; one that is there already stays as it is."""
    there = Campaign.objects.filter(dataset=demo.dataset, name=CAMPAIGN).first()
    if there:
        return there
    values = {
        "name": CAMPAIGN,
        "title": "The demo scene, for the own team",
        "platform": Campaign.Platform.OWN_TEAM,
        "batches_at_once": 2,
    }
    return states.take(editing.create(demo.dataset, values), "open")


def _make(slug: str, scene: Scene, progress: Progress) -> Dataset:
    cameras = load_cameras(CAMERAS)
    with TemporaryDirectory(prefix="demo-scene-") as scratch:
        folder = Path(scratch)
        try:
            truth = render_scene(
                scene, cameras, folder, lambda done, total: progress("rendering the scene", done, total)
            )
        except SceneError as error:
            hint = "try another seed or another number of frames"
            raise DemoError(f"{scene.frame_count} frames with seed {scene.seed}: {error}; {hint}") from error
        _write_calibrations(folder, cameras)
        _write_truth(folder, scene, cameras, truth)
        values = SceneValues(
            columns=scene.grid.columns,
            rows=scene.grid.rows,
            step=scene.grid.step,
            origin_x=scene.grid.origin_x,
            origin_y=scene.grid.origin_y,
            frame_rate=scene.numbers_per_second,
            frame_step=scene.number_step,
        )
        options = ImportOptions(
            slug=slug,
            folder=folder,
            name="Demo scene",
            preset="wildtrack",
            values=values,
            tvec_unit="m",
            layer=TRUTH,
            layer_kind=Layer.Kind.GROUND_TRUTH.value,
            hidden_layer=True,
        )
        return import_dataset(options, progress).dataset


def _write_calibrations(folder: Path, cameras: Sequence[Camera]) -> None:
    calibrations = folder / "calibrations"
    for camera in cameras:
        extrinsic = extrinsic_xml(Extrinsic(camera.rvec, camera.tvec), Style.MATRIX)
        write_bytes(calibrations / "extrinsic" / f"extr_C{camera.index + 1}.xml", extrinsic)
        intrinsic = intrinsic_xml(Intrinsic(camera.matrix, camera.distortion, camera.model))
        write_bytes(calibrations / "intrinsic_zero" / f"intr_C{camera.index + 1}.xml", intrinsic)


def _write_truth(folder: Path, scene: Scene, cameras: Sequence[Camera], truth: Sequence[Truth]) -> None:
    """Positions, boxes of each person's own height, and the true place and height as extra keys."""
    radius = PRESETS["wildtrack"].values["cylinder_radius"]
    frames: dict[int, list[PersonPosition]] = defaultdict(list)
    for number in scene.frame_numbers:
        frames[number] = []
    for row in truth:
        boxes = np.full((len(cameras), 4), -1, np.int32)
        for camera in cameras:
            box, visible = rectangles(
                camera, scene.grid, Cylinder(radius, row.height), FootRule.CORNERS, [row.position]
            )
            if visible[0]:
                boxes[camera.index] = box[0]
        extra = {"x": row.x, "y": row.y, "height": row.height}
        frames[row.number].append(PersonPosition(row.person, row.position, boxes, extra))
    for number, people in frames.items():
        write_frame(folder / "annotations_positions", FrameAnnotations(number, people), len(cameras))
