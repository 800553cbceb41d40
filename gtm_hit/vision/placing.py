"""Bodies that were found are put where boxes and foreground together say, to centimetres."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, Floats
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.cover import Body
from gtm_hit.vision.masks import Masks
from gtm_hit.vision.outlines import Shown


@dataclass(frozen=True)
class PlacingSettings:
    reach: float = 0.15  # metres from where a body is to where it is looked for …
    step: float = 0.05  # … at places so far apart
    rounds: int = 2  # the others stand better by then
    boxes: float = 0.5  # what the edges of the boxes count: views are off together
    shown: float = 0.2  # and the logarithm of the foreground's likelihood: neighbouring pixels say the same


def placed(
    bodies: Sequence[Body], foregrounds: Masks, cameras: Mapping[str, Camera], settings: PlacingSettings
) -> list[Body]:
    """The bodies, each moved to the middle of what is likely there with all the others explained."""
    start: Floats = np.array([[*body.xy, body.height] for body in bodies]).reshape(-1, 3)
    sure = [np.linalg.inv(body.spread) for body in bodies]
    around = _disc(settings)
    now = start
    for _ in range(settings.rounds):
        shown = [Shown(mask, cameras[name], now) for name, mask in foregrounds.items()]
        then = now.copy()
        for row, (body, first) in enumerate(zip(now, start, strict=True)):
            places = body + around
            off = (places - first)[:, :2]
            seen = sum((view.agreement(places, without=row) for view in shown), np.zeros(len(places)))
            if seen.any():
                boxed = -0.5 * np.einsum("na,ab,nb->n", off, sure[row], off)
                then[row] = _middle(places, settings.boxes * boxed + settings.shown * seen)
        now = then
    return [replace(body, xy=each[:2]) for body, each in zip(bodies, now, strict=True)]


def _disc(settings: PlacingSettings) -> Floats:
    """(N, 3) metres, to be added to a body."""
    count = int(settings.reach / settings.step + 1e-6)
    steps = settings.step * np.arange(-count, count + 1)
    around = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    around = around[np.hypot(*around.T) <= settings.reach + 1e-9]
    return np.column_stack((around, np.zeros(len(around))))


def _middle(places: Floats, likely: Floats) -> Floats:
    """Of places (N, 3) with logarithms of what is likely, (N,)."""
    weight = np.exp(likely - likely.max())
    middle: Floats = weight @ places / weight.sum()
    return middle


def steps_of(grid: Grid, metres: float) -> NDArray[np.int64]:
    """Every so-manieth position of a grid in both directions."""
    stride = max(1, round(metres / grid.step))
    rows = np.arange(stride // 2, grid.rows, stride)
    columns = np.arange(stride // 2, grid.columns, stride)
    ids: NDArray[np.int64] = (rows[:, None] * grid.columns + columns[None]).ravel()
    return ids
