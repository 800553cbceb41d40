"""People whom a model that looks at all views at once puts on the ground by itself."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, Protocol, runtime_checkable

from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.boxes import Picture


class Located(NamedTuple):
    x: float  # metres
    y: float
    score: float  # 0…1


@runtime_checkable
class Locator(Protocol):
    @property
    def version(self) -> str:
        """Names the model and everything its places depend on."""

    def locate(
        self, pictures: Mapping[str, Picture], cameras: Mapping[str, Camera], grid: Grid, frame: int
    ) -> list[Located]:
        """Of one frame; cameras without a picture are not among the pictures."""
