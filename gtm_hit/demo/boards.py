"""Pictures of calibration boards as a known camera would take them, to a hundredth of a pixel.

Each pixel is the mean of many rays, each bent back through the lens and met with the board's plane.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.artwork import extent, ink
from gtm_hit.calibration.boards import Board
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.geometry import lens as bending

Floats = NDArray[np.float64]
Grey = NDArray[np.uint8]

RAYS = 8  # per pixel and direction, at edges
LIGHT = np.array([0.0, 225.0, 35.0])  # grey levels of nothing, paper and ink
COVER = np.array([0.0, 1.0, 1.0])
GRID = 8  # pixels between the rays that are bent back exactly; between them the lens is smooth


@dataclass(frozen=True, eq=False)
class Placement:
    """A board before a camera: board to camera, metres."""

    rvec: Floats  # (3,)
    tvec: Floats  # (3,)

    @property
    def rotation(self) -> Floats:
        return np.asarray(cv2.Rodrigues(self.rvec)[0], dtype=np.float64)


def draw_board(picture: NDArray[np.float32], lens: Lens, board: Board, placement: Placement) -> None:
    """Paint the board over a grey picture (height, width) of the lens's size, edges smooth."""
    left, top, right, bottom = _box(lens, board, placement)
    if right - left < 3 or bottom - top < 3:
        return
    light, cover = _light(lens, board, placement, (left, top, right, bottom))
    part = picture[top:bottom, left:right]
    part += (light - part * cover).astype(np.float32)


def board_picture(
    lens: Lens, board: Board, placement: Placement, noise: float = 1.0, blur: float = 0.6, seed: int = 0
) -> Grey:
    """A picture of a board before a soft wall; `noise` in grey levels, `blur` in pixels, both sigmas."""
    picture = _background(lens, seed)
    draw_board(picture, lens, board, placement)
    if blur:
        picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), blur), dtype=np.float32)
    if noise:
        picture = picture + np.random.default_rng(seed).normal(0, noise, picture.shape).astype(np.float32)
    return np.clip(np.round(picture), 0, 255).astype(np.uint8)


def placements(lens: Lens, board: Board, count: int, seed: int = 0) -> Iterator[Placement]:
    """Where somebody who calibrates would hold the board: everywhere in the picture, leaning all ways."""
    rng = np.random.default_rng(seed)
    area = extent(board)
    middle = np.array([(area.left + area.right) / 2, (area.top + area.bottom) / 2, 0.0])
    given = 0
    while given < count:
        placement = _held(lens, board, middle, rng, given)
        if _is_inside(lens, board, placement):
            given += 1
            yield placement


def _held(lens: Lens, board: Board, middle: Floats, rng: np.random.Generator, number: int) -> Placement:
    angle = np.radians(rng.uniform(15, 45)) if number % 5 else np.radians(rng.uniform(0, 8))
    towards = 2 * np.pi * (number * 0.381966 + rng.uniform(0, 0.1))  # golden angle: all ways soon
    rvec = np.array([np.cos(towards), np.sin(towards), 0.0]) * angle
    spin = np.array([0.0, 0.0, rng.uniform(-0.4, 0.4)])
    rotation = cv2.Rodrigues(rvec)[0] @ cv2.Rodrigues(spin)[0]
    area = extent(board)
    reach = max(area.right - area.left, area.bottom - area.top)
    focal = float(lens.matrix[0, 0])
    depth = focal * reach / (lens.width * rng.uniform(0.3, 0.7))
    pixel = rng.uniform((0.05, 0.05), (0.95, 0.95)) * (lens.width, lens.height)
    ray = (pixel - lens.matrix[:2, 2]) / lens.matrix[[0, 1], [0, 1]]
    centre = depth * np.array([*ray, 1.0])
    turned = np.asarray(cv2.Rodrigues(rotation)[0], dtype=np.float64).ravel()
    return Placement(turned, centre - rotation @ middle)


def _outline(board: Board) -> Floats:
    """Points along the board's edge, (N, 3) metres."""
    area = extent(board)
    along = np.linspace(0, 1, 33)
    x, y = area.left + along * (area.right - area.left), area.top + along * (area.bottom - area.top)
    sides = [(x, np.full_like(x, area.top)), (x, np.full_like(x, area.bottom))]
    sides += [(np.full_like(y, area.left), y), (np.full_like(y, area.right), y)]
    return np.concatenate([np.column_stack((a, b, np.zeros_like(a))) for a, b in sides])


def _seen(lens: Lens, points: Floats, placement: Placement) -> tuple[Floats, bool]:
    """Pixels, and whether all points lie where the lens can see them."""
    x, y, z = (points @ placement.rotation.T + placement.tvec).T
    with np.errstate(all="ignore"):
        x, y = x / z, y / z
    sound = bool((z > 0).all() and (np.hypot(x, y) < bending.limit(lens.distortion)).all())
    bent = np.column_stack(bending.distort(x, y, lens.distortion))
    return bent * lens.matrix[[0, 1], [0, 1]] + lens.matrix[:2, 2], sound


def _is_inside(lens: Lens, board: Board, placement: Placement) -> bool:
    pixels, sound = _seen(lens, _outline(board), placement)
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    return sound and bool((low >= 1).all() and (high <= np.array((lens.width, lens.height)) - 2).all())


def _box(lens: Lens, board: Board, placement: Placement) -> tuple[int, int, int, int]:
    """Left, top, right and bottom pixel of what the board can cover; the whole picture where unclear."""
    pixels, sound = _seen(lens, _outline(board), placement)
    if not sound:
        return 0, 0, lens.width, lens.height
    (left, top), (right, bottom) = np.floor(pixels.min(0)) - 2, np.ceil(pixels.max(0)) + 3
    return max(0, int(left)), max(0, int(top)), min(lens.width, int(right)), min(lens.height, int(bottom))


def _light(
    lens: Lens, board: Board, placement: Placement, box: tuple[int, int, int, int]
) -> tuple[Floats, Floats]:
    """Light that the board sends into each pixel of a box, and the share of the pixel it covers."""
    left, top, right, bottom = box
    u, v = np.arange(left, right, dtype=np.float64), np.arange(top, bottom, dtype=np.float64)
    x, y = _on_board(placement, *_rays(lens, u, v))
    shade = _shades(board, x, y)
    light, cover = LIGHT[shade], COVER[shade]
    # Only where neighbours differ does a pixel need more than one ray.
    edges = cv2.dilate(shade, np.ones((3, 3))) != cv2.erode(shade, np.ones((3, 3)))
    slopes = [np.gradient(values, axis=axis)[edges] for values in (x, y) for axis in (0, 1)]
    light[edges], cover[edges] = 0.0, 0.0
    offsets = (np.arange(RAYS) + 0.5) / RAYS - 0.5
    with np.errstate(invalid="ignore"):
        for down in offsets:
            for across in offsets:
                at_x = x[edges] + slopes[0] * down + slopes[1] * across
                at_y = y[edges] + slopes[2] * down + slopes[3] * across
                shade = _shades(board, at_x, at_y)
                light[edges] += LIGHT[shade] / RAYS**2
                cover[edges] += COVER[shade] / RAYS**2
    return light, cover


def _shades(board: Board, x: Floats, y: Floats) -> NDArray[np.uint8]:
    """0: not on the board; 1: paper; 2: ink."""
    area = extent(board)
    with np.errstate(invalid="ignore"):
        on = (x >= area.left) & (x <= area.right) & (y >= area.top) & (y <= area.bottom)
    x, y = np.where(on, x, 0.0), np.where(on, y, 0.0)
    return np.where(on, 1 + (ink(board, x, y) != board.inverted), 0).astype(np.uint8)


def _on_board(placement: Placement, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Where rays meet the board's plane, metres on it; NaN where that is not before the camera."""
    rotation, tvec = placement.rotation, placement.tvec
    normal = rotation[:, 2]
    with np.errstate(all="ignore"):
        depth = (normal @ tvec) / (normal[0] * x + normal[1] * y + normal[2])
    depth = np.where(np.isfinite(depth) & (depth > 0), depth, np.nan)
    along = [depth * (axis[0] * x + axis[1] * y + axis[2]) - axis @ tvec for axis in rotation.T[:2]]
    return along[0], along[1]


def _rays(lens: Lens, u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """x/z and y/z, (v, u), of the pixels of a box: bent back exactly on a grid, cubic between."""
    coarse_u, coarse_v = _knots(u), _knots(v)
    grid_u, grid_v = np.meshgrid(coarse_u, coarse_v)
    fx, fy = lens.matrix[0, 0], lens.matrix[1, 1]
    bent_x, bent_y = (grid_u - lens.matrix[0, 2]) / fx, (grid_v - lens.matrix[1, 2]) / fy
    straight = bending.undistort(bent_x, bent_y, lens.distortion)
    across, down = _cubic(coarse_u, u), _cubic(coarse_v, v)
    return down @ straight[0] @ across.T, down @ straight[1] @ across.T


def _knots(values: Floats) -> Floats:
    return np.arange(values[0] - 2 * GRID, values[-1] + 3 * GRID, GRID, dtype=np.float64)


def _cubic(knots: Floats, values: Floats) -> Floats:
    """Weights (values, knots) of Lagrange's cubic through the four knots around each value."""
    at = (values - knots[0]) / GRID
    first = np.clip(np.floor(at).astype(int) - 1, 0, len(knots) - 4)
    t = at - first
    weights = np.zeros((len(values), len(knots)))
    rows = np.arange(len(values))
    for node in range(4):
        others = [other for other in range(4) if other != node]
        weights[rows, first + node] = np.prod([(t - o) / (node - o) for o in others], axis=0)
    return weights


def _background(lens: Lens, seed: int) -> NDArray[np.float32]:
    """A wall with soft patches of light."""
    rng = np.random.default_rng(seed + 1)
    patches = rng.uniform(70, 170, (7, 9)).astype(np.float32)
    wall = cv2.resize(patches, (lens.width, lens.height), interpolation=cv2.INTER_CUBIC)
    return np.asarray(wall, dtype=np.float32)
