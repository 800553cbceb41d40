"""A street seen by the seven WILDTRACK cameras: people of known positions, painted as plain figures."""

from __future__ import annotations

import uuid
from dataclasses import dataclass, replace
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.camera import Camera as CalibratedCamera
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid
from gtm_hit.models import Annotation, Assignment, Camera, Dataset, Frame, Image, Layer
from gtm_hit.ops.datasets.rows import add_cameras
from gtm_hit.ops.files import images
from gtm_hit.ops.frames.saving import save_frame
from gtm_hit.ops.work import assignments, batches, links, workers
from tests.conftest import REPOSITORY

GRID = Grid(columns=480, rows=1440, step=0.025, origin_x=-3.0, origin_y=-9.0)
CYLINDER = Cylinder(radius=0.16, height=1.80)
FRAME_STEP = 5


@cache
def cameras(views: int = 7) -> list[CalibratedCamera]:
    """The seven cameras; more views than that see the same again."""
    seven = load_cameras(REPOSITORY / "fixtures" / "wildtrack_cameras.json")
    return [replace(seven[index % 7], index=index, name=f"C{index + 1}") for index in range(views)]


@cache
def walks(people: int, frames: int) -> NDArray[np.int64]:
    """(frames, people) positions of people who walk straight on, about 0.6 m a frame; some stand."""
    rng = np.random.default_rng(7)
    start = rng.uniform([0.0, -1.0], [8.0, 14.0], (people, 2))
    step = rng.normal(0.0, 0.35, (people, 2)) * (rng.random((people, 1)) > 0.2)
    places = [GRID.nearest(start + step * index) for index in range(frames)]
    return np.stack(places)


@cache
def picture(camera_index: int, positions: tuple[int, ...]) -> tuple[str, str]:
    """Digests of the light and the full picture in the store."""
    camera = cameras(camera_index + 1)[camera_index]
    pixels = painted(camera, np.array(positions, dtype=np.int64))
    full = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, 85])[1].tobytes()
    light = cv2.imencode(".jpg", cv2.resize(pixels, None, fx=0.5, fy=0.5))[1].tobytes()
    return images.store(light), images.store(full)


def painted(camera: CalibratedCamera, positions: NDArray[np.int64]) -> NDArray[np.uint8]:
    pixels = np.full((camera.height, camera.width, 3), (96, 92, 88), dtype=np.uint8)
    cv2.rectangle(pixels, (0, 0), (camera.width, camera.height // 5), (140, 128, 112), -1)
    boxes, visible = rectangles(camera, GRID, CYLINDER, FootRule.CORNERS, positions)
    for index in np.argsort(boxes[:, 3]):
        if visible[index]:
            paint_figure(pixels, boxes[index], int(index))
    return pixels


def paint_figure(pixels: NDArray[np.uint8], box: NDArray[np.int16], index: int) -> None:
    xmin, ymin, xmax, ymax = (int(value) for value in box)
    width, height = xmax - xmin, ymax - ymin
    middle = (xmin + xmax) // 2
    rng = np.random.default_rng(index)
    coat, legs = (tuple(int(value) for value in rng.integers(30, 200, 3)) for _ in range(2))
    waist = ymin + height // 2
    cv2.rectangle(pixels, (middle - width // 6, waist), (middle + width // 6, ymax), legs, -1)
    cv2.rectangle(pixels, (middle - width // 4, ymin + height // 7), (middle + width // 4, waist), coat, -1)
    cv2.circle(pixels, (middle, ymin + height // 12), max(2, height // 12), (120, 150, 200), -1)


@dataclass(frozen=True)
class Street:
    dataset: Dataset
    frames: list[Frame]
    truth: NDArray[np.int64]
    """(frames, people) positions; column i is the person painted as i."""

    def claim(self, worker: str = "walker") -> Assignment:
        return assignments.claim(workers.enter("link", worker), self.dataset)


def workbench_path(assignment: Assignment) -> str:
    return f"/annotate/{links.assignment_token(assignment)}/"


def make_street(
    people: int = 6, frames: int = 3, size: int = 10, slug: str = "street", views: int = 7
) -> Street:
    """The dataset with its batches; pictures are made once per process and stored by content."""
    dataset = Dataset.objects.create(slug=slug, name=slug.title())
    add_cameras(dataset, cameras(views))
    truth = walks(people, frames)
    rows = Frame.objects.bulk_create(
        Frame(dataset=dataset, number=FRAME_STEP * index) for index in range(frames)
    )
    Image.objects.bulk_create(
        image_row(frame, camera, truth[index])
        for index, frame in enumerate(rows)
        for camera in dataset.cameras.all()
    )
    batches.make_batches(dataset, size)
    return Street(dataset, list(rows), truth)


def image_row(frame: Frame, camera: Camera, positions: NDArray[np.int64]) -> Image:
    light, full = picture(camera.index, tuple(int(position) for position in positions))
    return Image(
        frame=frame,
        camera=camera,
        source_digest="0" * 64,
        light_digest=light,
        full_digest=full,
        light_bytes=1,
        full_bytes=1,
    )


def annotate(
    assignment: Assignment, frame: Frame, positions: NDArray[np.int64], state: str = "validated"
) -> None:
    """Save a frame as people 1, 2, 3 … at the positions, as the worker would have."""
    rows = [
        {"person": index + 1, "position": int(position), "state": state, "origin": "clicked"}
        | {"height": None, "radius": None}
        for index, position in enumerate(positions)
    ]
    save_frame(assignment.layer, frame, assignment.worker, uuid.uuid4(), 0, rows)


def tell_truth(street: Street) -> None:
    """The hidden layer the tutorial is judged against."""
    layer = Layer.objects.create(
        dataset=street.dataset, name="truth", kind=Layer.Kind.GROUND_TRUTH, hidden=True
    )
    Annotation.objects.bulk_create(
        Annotation(layer=layer, frame=frame, person=person + 1, position=int(position))
        for frame, positions in zip(street.frames, street.truth, strict=True)
        for person, position in enumerate(positions)
    )
