"""Where a body stands and how tall it is, from the edges of its boxes in all views: robust least squares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, Floats
from gtm_hit.vision.bodies import body_boxes
from gtm_hit.vision.boxes import Box, as_array

NUDGE = 0.02  # metres, for the slopes
STEPS = 6
FURTHEST = 0.5  # metres one step may go
BORDER = 3.0  # pixels: an edge this near to the picture's border says nothing


@dataclass(frozen=True)
class FitSettings:
    radius: float = 0.20
    aside: float = 0.025  # how far a detector's box is off, as a share of its height: its middle,
    bottom: float = 0.030  # its feet
    top: float = 0.030  # and its head
    tolerance: float = 2.0  # from so many times that much on, an edge loses its say: hidden legs
    spread: float = 0.10  # metres, by which bodies of one kind differ in height


def fit(
    start: Floats,
    usual: Floats,
    boxes: Mapping[str, Floats],
    cameras: Mapping[str, Camera],
    settings: FitSettings,
) -> tuple[Floats, Floats]:
    """Places and heights (N, 3), and how sure each place is: its covariance (N, 2, 2).

    start : (N, 3) x, y, height
    usual : (N,) the height each is expected to have
    boxes : per camera (N, 4), NaN where a body has none
    """
    bodies = start.copy()
    said = {name: _edges_said(found, cameras[name]) for name, found in boxes.items()}
    for _ in range(STEPS):
        normal, slope = _prior(bodies, usual, settings)
        for name, edges in said.items():
            rows = np.flatnonzero(np.isfinite(edges).any(axis=1))
            if len(rows):
                view = _View(cameras[name], edges[rows])
                more_normal, more_slope = view.equations(bodies[rows], settings)
                normal[rows] += more_normal
                slope[rows] += more_slope
        step = np.linalg.solve(normal, slope[..., None])[..., 0]
        length = np.hypot(step[:, 0], step[:, 1])
        bodies += step * np.minimum(1.0, FURTHEST / np.maximum(length, 1e-9))[:, None]
        bodies[:, 2] = np.clip(bodies[:, 2], 0.5, 2.2)
    covariance: Floats = np.linalg.inv(normal).astype(np.float64)
    return bodies, covariance[:, :2, :2]


def _prior(bodies: Floats, usual: Floats, s: FitSettings) -> tuple[Floats, Floats]:
    normal = np.tile(np.diag([1e-3, 1e-3, s.spread**-2]), (len(bodies), 1, 1))
    slope = np.zeros((len(bodies), 3))
    slope[:, 2] = (usual - bodies[:, 2]) / s.spread**2
    return normal, slope


@dataclass(frozen=True, eq=False)
class _View:
    """What one camera says of some bodies, (N, 3) pixels: middle, bottom and top of the box; NaN: nothing."""

    camera: Camera
    edges: Floats

    def equations(self, bodies: Floats, s: FitSettings) -> tuple[Floats, Floats]:
        """Normal matrices (N, 3, 3) and slopes (N, 3) for the bodies' x, y and height."""
        seen, tall = _edges(bodies, self.camera, s)
        slopes = []
        for axis in range(3):
            moved = bodies.copy()
            moved[:, axis] += NUDGE
            slopes.append((_edges(moved, self.camera, s)[0] - seen) / NUDGE)
        spread = np.array((s.aside, s.bottom, s.top)) * tall[:, None]
        off, turn = (self.edges - seen) / spread, np.stack(slopes, axis=-1) / spread[..., None]
        weight = np.where(np.isfinite(off), 1 / (1 + (off / s.tolerance) ** 2), 0.0)
        off, turn = np.nan_to_num(off), np.nan_to_num(turn)
        normal = np.einsum("nea,neb,ne->nab", turn, turn, weight)
        return normal, np.einsum("nea,ne,ne->na", turn, off, weight)


def _edges_said(found: Floats, camera: Camera) -> Floats:
    said = np.column_stack(((found[:, 0] + found[:, 2]) / 2, found[:, 3], found[:, 1]))
    edges: Floats = np.where(_tells(found, camera), said, np.nan)
    return edges


def _edges(bodies: Floats, camera: Camera, s: FitSettings) -> tuple[Floats, Floats]:
    """Middle, bottom and top of the boxes expected, (N, 3) pixels, and their heights (N,)."""
    whole = body_boxes(camera, bodies[:, :2], s.radius, bodies[:, 2]).whole
    middle = (whole[:, 0] + whole[:, 2]) / 2
    return np.column_stack((middle, whole[:, 3], whole[:, 1])), whole[:, 3] - whole[:, 1]


def _tells(found: Floats, camera: Camera) -> NDArray[np.bool_]:
    """Which of middle, bottom and top are not cut by the picture's border, (N, 3)."""
    inner = (found[:, 0] > BORDER) & (found[:, 2] < camera.width - BORDER)
    return np.column_stack((inner, found[:, 3] < camera.height - BORDER, found[:, 1] > BORDER))


def chosen_boxes(
    boxes: Mapping[str, Sequence[Box]], chosen: Sequence[Mapping[str, int]]
) -> dict[str, Floats]:
    """Per camera (N, 4): the box of each body, NaN for none."""
    rows = {}
    for name, found in boxes.items():
        array = as_array(list(found))
        row = np.full((len(chosen), 4), np.nan)
        for place, body in enumerate(chosen):
            if name in body:
                row[place] = array[body[name], :4]
        rows[name] = row
    return rows
