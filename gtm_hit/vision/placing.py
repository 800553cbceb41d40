"""Bodies that were found are put where boxes and foreground together say, to centimetres."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, Floats
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.bodies import body_boxes
from gtm_hit.vision.boxes import Box
from gtm_hit.vision.cover import Body, CoverSettings
from gtm_hit.vision.fitting import chosen_boxes, fit
from gtm_hit.vision.silhouettes import SilhouetteSettings, silhouettes

ROUNDS = 2  # the foreground is looked at again from the better place
FURTHEST = 0.25  # metres the background may move somebody


def placed(
    bodies: Sequence[Body],
    boxes: Mapping[str, Sequence[Box]],
    foregrounds: Mapping[str, NDArray],
    cameras: Mapping[str, Camera],
    settings: CoverSettings,
    look: SilhouetteSettings,
) -> list[Body]:
    """The bodies, each moved by not more than `FURTHEST`; with all the others explained."""
    if not bodies:
        return []
    start = np.array([[*body.xy, body.height] for body in bodies])
    usual = _usual(start[:, 2], settings)
    found = chosen_boxes(boxes, [body.boxes for body in bodies])
    now, spread = start, np.array([body.spread for body in bodies])
    for _ in range(ROUNDS):
        seen = {
            name: _middles(now, cameras[name], mask, look, settings) for name, mask in foregrounds.items()
        }
        now, spread = fit(now, usual, found, cameras, settings.fit, seen)
        now = _held(start, now)
    return [
        replace(body, xy=each[:2], height=float(each[2]), spread=wide)
        for body, each, wide in zip(bodies, now, spread, strict=True)
    ]


def _middles(
    bodies: Floats, camera: Camera, mask: NDArray, look: SilhouetteSettings, settings: CoverSettings
) -> Floats:
    """Where the foreground shows the middle of each body, and how far that may be off, (N, 2)."""
    expected = body_boxes(camera, bodies[:, :2], settings.sight.radius, bodies[:, 2])
    found = silhouettes(mask, mask.shape[1] / camera.width, expected.whole, expected.share, look)
    return np.column_stack((found.middle, found.spread))


def _usual(heights: Floats, settings: CoverSettings) -> Floats:
    """The height of each body's kind."""
    known = np.array([height for height, _ in settings.heights])
    kinds: Floats = known[np.abs(heights[:, None] - known).argmin(axis=1)]
    return kinds


def _held(start: Floats, now: Floats) -> Floats:
    away = now[:, :2] - start[:, :2]
    far = np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-9)[:, None]
    held = now.copy()
    held[:, :2] = start[:, :2] + away * np.minimum(1.0, FURTHEST / far)
    return held


def steps_of(grid: Grid, metres: float) -> NDArray[np.int64]:
    """Every so-manieth position of a grid in both directions."""
    stride = max(1, round(metres / grid.step))
    rows = np.arange(stride // 2, grid.rows, stride)
    columns = np.arange(stride // 2, grid.columns, stride)
    ids: NDArray[np.int64] = (rows[:, None] * grid.columns + columns[None]).ravel()
    return ids
