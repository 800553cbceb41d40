"""Boxes everything dark: in the form of CVAT's auto-annotation functions, with stand-ins for its objects."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
import PIL.Image


class ShapeType(Enum):
    RECTANGLE = "rectangle"


@dataclass
class Label:
    name: str
    id: int


@dataclass
class Spec:
    labels: list[Label]


@dataclass
class Shape:
    type: ShapeType
    label_id: int
    points: list[float]


class Dark:
    spec = Spec([Label("car", 0), Label("person", 1)])

    def __init__(self, below: int) -> None:
        self.below = below

    def detect(self, context: Any, image: PIL.Image.Image) -> list[Shape]:
        assert context.frame_name == "" and context.conf_threshold is None
        rows, columns = np.nonzero(np.asarray(image.convert("L")) < self.below)
        if not len(rows):
            return []
        sides = [float(each) for each in (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)]
        return [Shape(ShapeType.RECTANGLE, label, sides) for label in (0, 1)]


def create(below: int = 60) -> Dark:
    return Dark(below)
