"""Videos of the demo scene, of any rate and from any instant on; people rendered or drawn quickly."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np

from gtm_hit.demo.arrays import Bytes, Floats
from gtm_hit.demo.backdrop import Place
from gtm_hit.demo.noise import cloudy
from gtm_hit.demo.people import Cast, moment
from gtm_hit.demo.scene import Scene
from gtm_hit.demo.view import View, photograph
from gtm_hit.demo.walks import TICK, Walks, make_walks
from gtm_hit.geometry.camera import Camera, project

CODES = {".mp4": "mp4v", ".avi": "MJPG", ".webm": "VP80"}
GRAIN_MARGIN = 31  # pixels by which the grain is moved from picture to picture
STRIDE = 0.34  # metres a foot is before or behind its owner, at most
TROUSERS, SKIN = 0.75, (160, 185, 215)

Painter = Callable[[Walks, int], Bytes]  # the picture (H, W, 3), BGR, of the frame with this index


@dataclass(frozen=True)
class Take:
    """One camera's video: its picture k shows the scene at `start + k / rate` seconds."""

    camera: Camera
    path: Path
    start: float  # seconds of the scene
    rate: float  # pictures per second
    seconds: float

    @property
    def times(self) -> Floats:
        return self.start + np.arange(round(self.seconds * self.rate)) / self.rate


def smaller(camera: Camera, width: int) -> Camera:
    """The same camera with fewer pixels."""
    scale = width / camera.width
    matrix = camera.matrix.copy()
    matrix[:2] *= scale
    matrix[:2, 2] += (scale - 1) / 2  # pixel centres are whole numbers
    return replace(camera, width=width, height=round(camera.height * scale), matrix=matrix)


def walks_for(scene: Scene, seconds: float) -> Walks:
    """Everybody's way, ten times a second."""
    count = int(np.ceil(seconds / TICK)) + 2
    scene = replace(scene, frame_count=count, number_step=1, numbers_per_second=1 / TICK)
    return make_walks(scene, scene.rng(1))


def at_times(walks: Walks, times: Floats) -> Walks:
    """The same walks at other instants, seconds from their beginning."""
    before = np.clip((times / TICK).astype(int), 0, len(walks.xy) - 2)
    share = times / TICK - before

    def mixed(values: Floats) -> Floats:
        part = share.reshape(-1, *(1,) * (values.ndim - 1))
        return values[before] * (1 - part) + values[before + 1] * part

    return replace(
        walks,
        xy=mixed(walks.xy),
        heading=mixed(walks.heading),
        phase=mixed(walks.phase),
        present=walks.present[before],
    )


def film(take: Take, walks: Walks, paint: Painter) -> Path:
    """Write the video; its pictures are at whole multiples of 1 / rate."""
    code = cv2.VideoWriter.fourcc(*CODES[take.path.suffix])
    size = (take.camera.width, take.camera.height)
    writer = cv2.VideoWriter(str(take.path), cv2.CAP_FFMPEG, code, take.rate, size)
    if not writer.isOpened():
        raise OSError(f"{take.path} cannot be written")
    there = at_times(walks, take.times)
    for index in range(len(take.times)):
        writer.write(paint(there, index))
    writer.release()
    return take.path


def quick_painter(scene: Scene, camera: Camera) -> Painter:
    """Walking figures of a few strokes in front of a cloudy ground: milliseconds a picture."""
    rng = scene.rng(50, camera.index)
    ground = 120 + 25 * cloudy(rng, (camera.height, camera.width), 1.5)
    empty = np.repeat(np.clip(ground, 0, 255).astype(np.uint8)[..., None], 3, axis=2)
    grain = rng.integers(-3, 4, (camera.height + GRAIN_MARGIN, camera.width + GRAIN_MARGIN, 3), np.int8)
    colours = scene.rng(51).integers(10, 245, (1000, 3))

    def paint(walks: Walks, index: int) -> Bytes:
        picture = empty.copy()
        away = np.linalg.norm(walks.xy[index] - camera.centre[:2], axis=1)
        for person in np.argsort(-away, kind="stable"):
            _draw(picture, camera, walks, index, int(person), colours[person].tolist())
        dx, dy = scene.rng(52, camera.index, index).integers(0, GRAIN_MARGIN, 2)
        noise = grain[dy : dy + camera.height, dx : dx + camera.width]
        return np.asarray(cv2.add(picture, np.ascontiguousarray(noise), dtype=cv2.CV_8U), np.uint8)

    return paint


def true_painter(scene: Scene, camera: Camera, place: Place, cast: Cast) -> Painter:
    """As the demo's pictures are: about half a second each."""
    view = View.of(scene, camera, place.backdrop(camera))

    def paint(walks: Walks, index: int) -> Bytes:
        playing = replace(cast, walks=walks)
        now = moment(playing, index, (place.sun_map, place.shade))
        return np.asarray(photograph(scene, camera, view, playing, now, index)[..., ::-1])

    return paint


def _draw(
    picture: Bytes, camera: Camera, walks: Walks, index: int, person: int, colour: Sequence[int]
) -> None:
    pixels = project(camera, np.array(list(_joints(walks, index, person))))
    depth = (camera.rotation @ [*walks.xy[index, person], 1.0] + camera.tvec)[2]
    if depth < 0.5 or not np.isfinite(pixels).all() or np.abs(pixels).max() > 4 * camera.width:
        return
    metre = camera.matrix[0, 0] / depth
    left, right, hip, neck, head = (tuple(np.round(point * 16).astype(int).tolist()) for point in pixels)

    def limb(start: tuple[int, ...], end: tuple[int, ...], width: float, shade: float) -> None:
        tint = tuple(value * shade for value in colour)
        cv2.line(picture, start, end, tint, max(round(width * metre), 1), cv2.LINE_AA, 4)

    limb(left, hip, 0.15, TROUSERS * 0.8)
    limb(right, hip, 0.15, TROUSERS)
    limb(hip, neck, 0.38, 1.0)
    cv2.circle(picture, head, max(round(0.11 * metre * 16), 16), SKIN, -1, cv2.LINE_AA, 4)


def _joints(walks: Walks, index: int, person: int) -> Iterator[tuple[float, float, float]]:
    """Left and right foot, hip, neck, head."""
    x, y = walks.xy[index, person].tolist()
    heading, phase = walks.heading[index, person], walks.phase[index, person]
    reach = STRIDE * np.sin(phase) * min(walks.speed[person], 1.0)
    height = float(walks.height[person])
    for sign in (1, -1):
        yield x + sign * reach * np.cos(heading), y + sign * reach * np.sin(heading), 0.03
    for share in (0.5, 0.83, 0.93):
        yield x, y, share * height
