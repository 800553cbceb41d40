"""NanoDet, a person detector that runs in OpenCV: the whole picture at several sizes, one list of boxes.

The small sizes find those who fill the picture, the large ones those far away. Its file is made by
`make detector`; see docs/automation.md.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path
from threading import Lock
from typing import Any

import cv2
import numpy as np

from gtm_hit.vision.boxes import Box, Floats, Picture, overlaps
from gtm_hit.vision.detectors.errors import DetectorError

FILE_NAME = "nanodet_g_416.onnx"
MEAN = (103.53, 116.28, 123.675)  # blue green red, as the network was trained
SPREAD = (57.375, 57.12, 58.395)
STRIDES = (8, 16, 32)
BINS = 11  # a side's distance is a distribution over so many strides
PERSON = 0  # COCO's first class
COARSEST = 32  # pictures are fed in multiples of the largest stride
WIDTHS = (416, 992)  # the picture is looked at in these widths
LOWEST = 0.25  # boxes below are not worth keeping: most of them are nobody
SAME = 0.6  # boxes of one person in several sizes overlap by more than this
RULE = 1  # counts changes of what is done here: part of the version


class NanoDet:
    def __init__(self, model: bytes) -> None:
        try:
            self._net = cv2.dnn.readNetFromONNX(np.frombuffer(model, np.uint8))
        except cv2.error as error:
            raise DetectorError(f"OpenCV cannot read the detector: {error}") from error
        self._outputs = self._net.getUnconnectedOutLayersNames()
        self._turn = Lock()  # a network holds what it last computed
        self.version = f"nanodet-{hashlib.sha256(model).hexdigest()[:12]}-{RULE}"

    @classmethod
    def load(cls, path: Path) -> NanoDet:
        try:
            return cls(path.read_bytes())
        except OSError as error:
            raise DetectorError(f"{path}: {error.strerror}") from error

    def detect(self, image: Picture) -> list[Box]:
        found = np.concatenate([self._look(image, width) for width in WIDTHS])
        return [Box(*row) for row in merged(found, SAME).tolist()]

    def _look(self, image: Picture, width: int) -> Floats:
        """Boxes (N, 5) of the picture shrunk to a width, in pixels of the picture."""
        scale = width / image.shape[1]
        height = max(1, round(image.shape[0] * scale))
        shape = (-(-height // COARSEST) * COARSEST, -(-width // COARSEST) * COARSEST)
        blob = _blob(cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA), shape)
        with self._turn:
            self._net.setInput(blob)
            outputs = self._net.forward(self._outputs)
        boxes = np.concatenate(list(_decoded(outputs, shape)))
        boxes[:, :4] = np.clip(boxes[:, :4], 0, (width, height, width, height)) / scale
        return boxes


def _blob(image: Any, shape: tuple[int, int]) -> np.ndarray:
    """(1, 3, rows, columns) with the picture at the top left."""
    filled = np.zeros((*shape, 3), np.float32)
    filled[: image.shape[0], : image.shape[1]] = (image.astype(np.float32) - MEAN) / SPREAD
    return np.ascontiguousarray(filled.transpose(2, 0, 1)[None])


def _decoded(outputs: Any, shape: tuple[int, int]) -> Iterator[Floats]:
    """Boxes (N, 5) per stride; which output is which is told by its shape."""
    by_shape = {output.shape[1:]: output[0] for output in outputs}
    for stride in STRIDES:
        rows, columns = shape[0] // stride, shape[1] // stride
        scores = by_shape[rows * columns, 80][:, PERSON]
        likely = np.flatnonzero(scores > LOWEST)
        bins = by_shape[rows * columns, 4 * BINS][likely].reshape(-1, 4, BINS)
        weights = np.exp(bins - bins.max(axis=2, keepdims=True))
        sides = weights @ np.arange(BINS) / weights.sum(axis=2) * stride
        centres = np.column_stack((likely % columns, likely // columns)) * stride + stride / 2
        yield np.column_stack((centres - sides[:, :2], centres + sides[:, 2:], scores[likely]))


def merged(boxes: Floats, same: float) -> Floats:
    """The best box (M, 5) of each heap of boxes (N, 5) that overlap by more than `same`, best first."""
    left = boxes[np.argsort(-boxes[:, 4], kind="stable")]
    kept = []
    while len(left):
        kept.append(left[0])
        left = left[1:][overlaps(left[:1], left[1:])[0] <= same]
    return np.array(kept, dtype=np.float64).reshape(-1, 5)
