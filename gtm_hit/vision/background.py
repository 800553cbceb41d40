"""What a camera sees when nobody is there, learned from the frames of a batch, and how far it can be trusted.

The background is each pixel's median over the frames. It is no background where somebody stood still most of
the time, and with few frames nobody can tell; so every pixel says how many frames agree with it, and what
builds on the background looks at that. Half the picture's size is enough.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera
from gtm_hit.vision.boxes import Picture

Small = NDArray[np.uint8]
Pictures = Mapping[str, Picture]  # camera → its picture; a camera without one is left out

WIDTH = 960  # pixels that a picture is shrunk to
FEWEST = 5  # frames from which a background is learned at all
NOISE = 6.0  # levels of grey by which equal pixels differ
DIFFERENT = 3.0  # times their noise by which pixels are not the background's
AGREE = 0.6  # share of the frames that must show the background for it to be trusted


@dataclass(frozen=True, eq=False)
class Background:
    """Of one camera, at the reduced size."""

    usual: NDArray[np.float32]  # (h, w, 3)
    noise: NDArray[np.float32]  # (h, w) levels
    trust: NDArray[np.float32]  # (h, w) 0…1: 0 where it is not known to be the background
    scale: float  # pixels here per pixel of the calibrated picture

    def foreground(self, picture: Picture) -> NDArray[np.float32]:
        """How surely each pixel is not the background, (h, w), 0…1; 0.5 where nothing can be said."""
        small = _shrunk(picture, self.usual.shape[1]).astype(np.float32)
        small *= _gain(small, self.usual, self.trust)
        off = _largest(cv2.absdiff(small, self.usual)) / self.noise
        off = np.asarray(cv2.GaussianBlur(off, (5, 5), 0))
        sure = np.clip((off - 1.0) / (2 * DIFFERENT - 2), 0, 1)
        return np.asarray(0.5 + self.trust * (sure - 0.5), dtype=np.float32)


class Backgrounds:
    """Of all cameras; empty where there were too few frames."""

    def __init__(self, cameras: dict[str, Background]) -> None:
        self.cameras = cameras

    @classmethod
    def learn(
        cls,
        frames: Sequence[Pictures],
        cameras: Mapping[str, Camera],
        report: Callable[[int], None] | None = None,
    ) -> Backgrounds:
        """Camera by camera, so that only one camera's pictures are in memory; reports cameras done."""
        learned = {}
        for done, (name, camera) in enumerate(cameras.items(), start=1):
            pictures = [_shrunk(frame[name], WIDTH) for frame in frames if name in frame]
            if len(pictures) >= FEWEST:
                learned[name] = _learned(pictures, WIDTH / camera.width)
            if report is not None:
                report(done)
        return cls(learned)


def _learned(pictures: list[Small], scale: float) -> Background:
    usual = _median(pictures)
    off = [_largest(cv2.absdiff(each, usual)) for each in pictures]
    noise = np.asarray(np.clip(1.5 * _median(off), NOISE, 4 * NOISE), dtype=np.float32)
    agree = np.mean([each < DIFFERENT * noise for each in off], axis=0)
    trust = np.asarray(np.clip((agree - AGREE) / (0.8 - AGREE), 0, 1), dtype=np.float32)
    return Background(usual.astype(np.float32), noise, trust, scale)


def _median(planes: Sequence[Small]) -> Small:
    """Of each pixel over the planes; of an even number the lower middle, for halfway between the ground and a
    coat there is nothing. Whole planes are sorted by a network of minima and maxima: many times as fast as
    pixel by pixel.
    """
    ordered = list(planes)
    for first, second in _network(len(ordered)):
        one, other = ordered[first], ordered[second]
        ordered[first], ordered[second] = np.minimum(one, other), np.maximum(one, other)
    return ordered[(len(ordered) - 1) // 2]


def _network(count: int) -> Iterator[tuple[int, int]]:
    """Pairs to put in order, one after the other, until all are: Batcher's odd-even merge sort."""
    size = 1
    while size < count:
        step = size
        while step >= 1:
            for start in range(step % size, count - step, 2 * step):
                for first in range(start, min(start + step, count - step)):
                    if first // (2 * size) == (first + step) // (2 * size):
                        yield first, first + step
            step //= 2
        size *= 2


def _largest(colours: NDArray) -> NDArray[Any]:
    """Of the three colours, (h, w)."""
    blue, green, red = cv2.split(colours)
    largest: NDArray[Any] = np.maximum(np.maximum(blue, green), red)
    return largest


def _shrunk(picture: Picture, width: int) -> Small:
    height = max(1, round(picture.shape[0] * width / picture.shape[1]))
    return np.asarray(cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def _gain(small: NDArray, usual: NDArray, trust: NDArray) -> NDArray[np.float32]:
    """By how much this picture's colours must be multiplied to be those of the background, (3,)."""
    some = np.s_[::3, ::2]
    known = trust[some] > 0.5
    if known.mean() < 0.1:
        return np.ones(3, np.float32)
    ratio = (usual[some][known] + 8) / (small[some][known] + 8)
    return np.clip(np.median(ratio, axis=0), 0.8, 1.25).astype(np.float32)
