"""Videos whose every picture tells which one it is, also after a codec and a lens."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from gtm_hit.ops.datasets.videos.options import VideoOptions, VideoSource
from tests.dataset_folder import NAMES, VALUES, add_calibrations, options

BITS = 10
SIZE = (320, 240)


def painted(number: int, size: tuple[int, int] = SIZE) -> np.ndarray:
    """A row of black and white squares: the number's bits, lowest first."""
    pixels = np.full((size[1], size[0], 3), 128, np.uint8)
    width = size[0] // BITS
    for bit in range(BITS):
        pixels[:, bit * width : (bit + 1) * width] = 255 * (number >> bit & 1)
    return pixels


def number_in(pixels: np.ndarray) -> int:
    height, width = pixels.shape[:2]
    return sum(
        1 << bit for bit in range(BITS) if pixels[height // 2, int((bit + 0.5) * width / BITS)].mean() > 127
    )


def make_video(
    path: Path, count: int, rate: float = 30.0, first: int = 0, size: tuple[int, int] = SIZE
) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    code = "MJPG" if path.suffix == ".avi" else "mp4v"
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*code), rate, size)
    assert writer.isOpened()
    for number in range(first, first + count):
        writer.write(painted(number, size))
    writer.release()
    return path


def make_uneven_video(path: Path, milliseconds: Sequence[int]) -> Path:
    """One picture at each of these times."""
    options = [cv2.VIDEOWRITER_PROP_RAW_VIDEO, 1]
    code = cv2.VideoWriter.fourcc(*"MJPG")
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, code, 1000, SIZE, options)
    assert writer.isOpened()
    for number, time in enumerate(milliseconds):
        writer.set(cv2.VIDEOWRITER_PROP_PTS, time)
        writer.write(cv2.imencode(".jpg", painted(number))[1].reshape(1, -1))
    writer.release()
    return path


def make_videos(root: Path, count: int = 90, rate: float = 30.0, suffix: str = ".mp4") -> list[Path]:
    """One per camera of `dataset_folder`, with its calibrations beside them."""
    add_calibrations(root)
    return [make_video(root / f"{name}{suffix}", count, rate) for name in NAMES]


def video_options(root: Path, *offsets: float, **changes: object) -> VideoOptions:
    """For the videos of `make_videos`."""
    suffix = next(path.suffix for path in root.iterdir() if path.stem == NAMES[0])
    sources = tuple(
        VideoSource(name, root / f"{name}{suffix}", offset)
        for name, offset in zip(NAMES, offsets or [0.0] * len(NAMES), strict=True)
    )
    values = {**VALUES, **changes.pop("values", {})}  # type: ignore[dict-item]
    times = {key: changes.pop(key) for key in ("start", "until") if key in changes}
    dataset = options(root, values=values, undistort=True, **changes)
    return VideoOptions(dataset, sources, **times)  # type: ignore[arg-type]
