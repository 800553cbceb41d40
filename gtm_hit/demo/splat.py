"""Draws lofted parts: every surface is sampled finer than the pixels, and the nearest sample wins."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from gtm_hit.demo.arrays import Flags, Floats, Indices
from gtm_hit.demo.loft import Part
from gtm_hit.geometry.camera import Camera

DENSITY = 0.95  # samples per pixel side; each covers two, and rows of samples may run across the pixels
DETAILS_FROM = 420  # rows of samples that a picture must have for small parts to be drawn
NEAR = 0.6  # metres; what comes closer to a camera is not drawn


@dataclass(frozen=True)
class Mesh:
    """Parts in the world with the light that falls on their points."""

    parts: tuple[Part, ...]
    vertices: Floats  # (N, 3) metres, the parts' points one after the other
    normals: Floats  # (N, 3)
    light: Floats  # (N, 3)


@dataclass(frozen=True)
class Sprite:
    """A picture of one object in one view, to be laid over what is behind it."""

    left: int  # pixel of the view the sprite starts in
    top: int
    colour: Floats  # (h, w, 3) linear light times cover
    cover: Floats  # (h, w) 0…1
    depth: float  # metres along the optical axis


def draw(camera: Camera, mesh: Mesh) -> Sprite | None:
    """The mesh as the camera sees it; None when it is outside the image or too close."""
    seen = mesh.vertices @ camera.rotation.T + camera.tvec
    depth = seen[:, 2]
    if depth.min() < NEAR:
        return None
    u = camera.matrix[0, 0] * seen[:, 0] / depth + camera.matrix[0, 2]
    v = camera.matrix[1, 1] * seen[:, 1] / depth + camera.matrix[1, 2]
    left, right = max(int(np.floor(u.min())) - 1, 0), min(int(np.ceil(u.max())) + 2, camera.width)
    top, bottom = max(int(np.floor(v.min())) - 1, 0), min(int(np.ceil(v.max())) + 2, camera.height)
    if left >= right or top >= bottom:
        return None
    fine = _fineness(float(v.max() - v.min()))
    shape = (round((bottom - top) * fine), round((right - left) * fine))
    towards = np.sum((camera.centre - mesh.vertices) * mesh.normals, axis=1)
    placed = np.column_stack(((u + 0.5 - left) * fine, (v + 0.5 - top) * fine, depth, towards))
    image, hit = rasterise(mesh, placed.astype(np.float32), shape)
    size = (right - left, bottom - top)
    cover = _shrunk(hit.astype(np.float32), size)
    colour = _shrunk(image, size)
    return Sprite(left, top, colour, cover, float(depth.mean()))


def rasterise(mesh: Mesh, placed: Floats, shape: tuple[int, int]) -> tuple[Floats, Flags]:
    """Colours (h, w, 3) and which pixels are hit.

    `placed` is (N, 4): x and y in pixels, depth, how much the surface faces the viewer; backs are left out.
    """
    values = np.concatenate((placed, mesh.light), axis=1)
    shown = _by_part(mesh.parts, values, shape)
    if shape[0] < DETAILS_FROM:
        shown = [(part, rows) for part, rows in shown if not part.detail]
    samples = [_samples(part, rows) for part, rows in shown]
    if not samples:
        return np.zeros((*shape, 3), np.float32), np.zeros(shape, np.bool_)
    colour = np.concatenate([colour for _, colour in samples])
    place = np.concatenate([place for place, _ in samples])
    winner = nearest_samples(place, shape)
    hit = winner >= 0
    image = np.zeros((*shape, 3), dtype=np.float32)
    image[hit] = colour[winner[hit]]
    return image, hit


def nearest_samples(place: Floats, shape: tuple[int, int]) -> Indices:
    """Which sample is the nearest in every pixel (h, w), -1 where there is none, of (N, 4) as in `rasterise`.

    A sample covers the 2 by 2 pixels around it, so that samples a pixel apart leave no holes.
    """
    height, width = shape
    column, row = (place[:, axis] - np.float32(0.5) for axis in (0, 1))
    within = (column >= 0) & (column < width - 1) & (row >= 0) & (row < height - 1)
    inside = np.flatnonzero(within & (place[:, 3] > 0))
    winner = np.full(height * width, -1, dtype=np.int32)
    if len(inside):
        inside = inside[far_to_near(place[inside, 2])].astype(np.int32)
        pixel = row[inside].astype(np.int32) * width + column[inside].astype(np.int32)
        # Of several samples in one pixel the last written, the nearest, stays.
        corners = pixel[:, None] + np.array([0, 1, width, width + 1], dtype=np.int32)
        winner[corners.ravel()] = np.repeat(inside, 4)
    return winner.reshape(shape)


def far_to_near(depth: Floats) -> Indices:
    """Order of depths. 16 bits make it a radix sort, which is ten times as fast."""
    nearest, farthest = float(depth.min()), float(depth.max())
    steps = (farthest - depth) * np.float32(65535 / max(farthest - nearest, 1e-6))
    return np.argsort(steps.astype(np.uint16), kind="stable")


def sample_parts(mesh: Mesh, placed: Floats, shape: tuple[int, int]) -> Floats:
    """Only the places (N, 4) of the samples that `rasterise` would draw."""
    found = _by_part(mesh.parts, placed, shape)
    return np.concatenate([_spread(rows, *_density(rows)).reshape(-1, 4) for _, rows in found])


def _by_part(parts: tuple[Part, ...], values: Floats, shape: tuple[int, int]) -> list[tuple[Part, Floats]]:
    """The parts that come into a picture of this shape, with their points' values (R, S + 1, k)."""
    found, start = [], 0
    for part in parts:
        rings, columns = part.points.shape[:2]
        rows = values[start : start + rings * columns]
        start += rings * columns
        outside = (rows[:, :2].max(axis=0) < 0) | (rows[:, :2].min(axis=0) > shape[::-1])
        if not outside.any():
            found.append((part, rows.reshape(rings, columns, -1)))
    return found


def _samples(part: Part, values: Floats) -> tuple[Floats, Floats]:
    """Places (N, 4) and colours (N, 3) of samples; values (R, S + 1, 7) are the points' places and light."""
    front = _front(values[..., 3])
    if front is None:
        return np.zeros((0, 4), np.float32), np.zeros((0, 3), np.float32)
    start, count = front
    sectors, width = values.shape[1] - 1, part.colours.shape[1]
    values = values[:, (start + np.arange(count + 1)) % sectors]
    stripe = (round(start / sectors * width) + np.arange(max(round(count / sectors * width), 2))) % width
    rings, columns = _density(values)
    spread = _spread(values, rings, columns)
    rows = rings * ((len(part.colours) - 1) / (len(values) - 1))
    colour = _spread(part.colours[:, stripe], rows, columns)
    colour *= spread[..., 4:]
    return spread[..., :4].reshape(-1, 4), colour.reshape(-1, 3)


def _front(facing: Floats) -> tuple[int, int] | None:
    """The first sector and the number of sectors of a part of which something faces the viewer."""
    sectors = facing.shape[1] - 1
    seen = (facing[:, :sectors] > 0).any(axis=0)
    if not seen.any():
        return None
    if seen.all():
        return 0, sectors
    turn = int(np.argmin(seen))  # start counting where it is turned away, so that the front is in one piece
    shown = np.flatnonzero(np.roll(seen, -turn))
    first = int(shown[0]) - 1
    return (turn + first) % sectors, min(int(shown[-1]) + 1 - first, sectors)


def _density(placed: Floats) -> tuple[Floats, int]:
    """Between which rings (n,) to sample, evenly along the surface in pixels, and how many times around."""
    x, y = placed[..., 0], placed[..., 1]
    down = np.hypot(x[1:] - x[:-1], y[1:] - y[:-1])
    sectors = np.hypot(x[:, 1:] - x[:, :-1], y[:, 1:] - y[:, :-1])
    along = np.concatenate(([0.0], down.max(axis=1).cumsum()))
    around = max(float(sectors.sum(axis=1).max()), 0.8 * float(sectors.max()) * sectors.shape[1])
    count = max(int(along[-1] * DENSITY), 2)
    rings = np.interp(np.arange(count + 1) * (along[-1] / count), along, np.arange(len(placed)))
    return rings.astype(np.float32), max(int(around * DENSITY), 3)


def _spread(values: Floats, rings: Floats, columns: int) -> Floats:
    """Values (n, columns, k) between the given rows of (R, S, k), stretched to so many columns."""
    lower = np.minimum(rings.astype(np.intp), len(values) - 2)
    share = (rings - lower)[:, None, None]
    rows = values[lower] * (1 - share) + values[lower + 1] * share
    return cv2.resize(rows, (columns, len(rings)), interpolation=cv2.INTER_LINEAR)


def _shrunk(values: Floats, size: tuple[int, int]) -> Floats:
    return np.asarray(cv2.resize(values, size, interpolation=cv2.INTER_AREA), np.float32)


def _fineness(height: float) -> float:
    """Into how many samples a pixel is divided along each side."""
    return 2.0 if height < 180 else 1.5 if height < 420 else 1.25
