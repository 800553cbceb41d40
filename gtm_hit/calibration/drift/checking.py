"""What is said of a camera in a later picture: pixels, centimetres on the ground, and a verdict in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gtm_hit.calibration.drift.field import Movement, movement
from gtm_hit.calibration.drift.finding import find
from gtm_hit.calibration.drift.marks import DriftError, Grey, Marks
from gtm_hit.geometry.camera import Camera, Floats, back_project

STEADY, WARN = 0.5, 2.0  # pixels
LATTICE = 15  # pixels across and down at which the ground is asked
FARTHEST = 60.0  # metres; beyond, a pixel is a street long

MOVED, A_LITTLE, STILL, UNKNOWN = "moved", "a little", "steady", "cannot tell"


@dataclass(frozen=True)
class Drift:
    """Of one camera in one picture. Figures are None where nothing can be told."""

    camera: str
    state: str  # MOVED, A_LITTLE, STILL or UNKNOWN
    px: float | None  # median over the marks
    most_px: float | None
    sigma_px: float | None
    cm: float | None  # on the ground, median over the view; None: no calibration, or no ground in view
    degrees: float | None
    scale: float | None
    found: int  # marks that agree
    marks: int  # that were remembered
    arrows: tuple[tuple[float, float, float, float], ...]  # x, y, dx, dy of every mark that agrees

    @property
    def verdict(self) -> str:
        if self.px is None or self.most_px is None:
            left = f"{self.found} of {self.marks}"
            return f"{self.camera}: cannot tell, the picture has too few marks left ({left})."
        ground = "" if self.cm is None else f" ({self.cm:.1f} cm on the ground)"
        if self.state == STILL:
            return f"{self.camera} is steady: {self.px:.1f} px."
        if self.state == A_LITTLE:
            little = f"{self.camera} has moved a little: {self.px:.1f} px{ground}"
            return f"{little}, below the {WARN:g} px that are warned of."
        most = f", up to {self.most_px:.1f} px" if self.most_px > self.px + 0.5 else ""
        return f"{self.camera} has moved by {self.px:.1f} px{most}{ground}."

    def as_json(self) -> dict[str, Any]:
        told = {
            "camera": self.camera,
            "state": self.state,
            "verdict": self.verdict,
            "found": self.found,
            "marks": self.marks,
            "arrows": [[round(value, 2) for value in arrow] for arrow in self.arrows],
        }
        for name in ("px", "most_px", "sigma_px", "cm"):
            value = getattr(self, name)
            told[name] = None if value is None else round(value, 3)
        for name in ("degrees", "scale"):
            value = getattr(self, name)
            told[name] = None if value is None else round(value, 6)
        return told


def check(name: str, marks: Marks, picture: Grey, camera: Camera | None = None) -> Drift:
    """Compares a grey picture with the marks. Raises DriftError for one of another size."""
    there = (picture.shape[1], picture.shape[0])
    if there != (marks.width, marks.height):
        raise DriftError(
            f"{name}: the picture has {there[0]}×{there[1]} pixels, "
            f"its marks are of one with {marks.width}×{marks.height}"
        )
    found = find(marks, picture)
    moved = movement(found, len(marks.marks))
    if moved is None:
        return Drift(name, UNKNOWN, None, None, None, None, None, None, len(found), len(marks.marks), ())
    state = MOVED if moved.most_px > WARN else STILL if moved.most_px < STEADY else A_LITTLE
    return Drift(
        name,
        state,
        moved.px,
        moved.most_px,
        moved.sigma_px,
        None if camera is None else on_ground(camera, moved),
        moved.degrees,
        moved.scale,
        len(moved.marks),
        len(marks.marks),
        tuple((mark.x, mark.y, mark.dx, mark.dy) for mark in moved.marks),
    )


def on_ground(camera: Camera, moved: Movement) -> float | None:
    """By how many cm the calibration now misplaces what is on the ground: the median over the view."""
    pixels = _lattice(camera)
    before, after = back_project(camera, pixels), back_project(camera, moved.moved(pixels))
    distance = np.hypot(*(before - camera.centre[:2]).T)
    apart = np.hypot(*(after - before).T)
    seen = np.isfinite(apart) & (distance < FARTHEST)
    return 100 * float(np.median(apart[seen])) if seen.any() else None


def _lattice(camera: Camera) -> Floats:
    across = np.linspace(0, camera.width - 1, LATTICE)
    down = np.linspace(0, camera.height - 1, LATTICE)
    return np.stack(np.meshgrid(across, down), axis=-1).reshape(-1, 2)
