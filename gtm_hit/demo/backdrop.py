"""The place without people, as one camera sees it: every pixel's ray is followed to what it hits first."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from gtm_hit.demo.arrays import Flags, Floats, Indices
from gtm_hit.demo.facades import Wall, walls
from gtm_hit.demo.ground import STREET, Floor, Spot
from gtm_hit.demo.light import HAZE, HAZE_DISTANCE, skylight, sunlight
from gtm_hit.demo.noise import looked_up
from gtm_hit.demo.panorama import Panorama
from gtm_hit.demo.props import props
from gtm_hit.demo.scene import Area, Scene
from gtm_hit.demo.shadows import SunMap, beam
from gtm_hit.demo.splat import Sprite, draw
from gtm_hit.geometry.camera import Camera

FINE = 2  # samples per pixel along each side where edges need them
COARSE = 24.0  # metres beyond which the ground's pattern needs them
TILE = (90, 160)  # rows and columns worked on at a time, so that arrays stay in the cache
FAR = 1e4  # metres
SHADOW_CELL = 0.03  # metres
SURROUNDINGS = Area(-18.0, 25.0, -30.0, 52.0)  # where shadows of things that stand still are kept


@dataclass(frozen=True)
class Backdrop:
    """Light (H, W, 3) with and without the sun, and where each pixel's sunbeam meets the ground."""

    sunny: Floats
    shaded: Floats
    beams: Floats  # (H, W, 2) metres; NaN in the sky


@dataclass(frozen=True)
class _Patch:
    """Some pixels of a picture."""

    top: int
    left: int
    rows: int
    columns: int


@dataclass
class _Tile:
    """Samples of some pixels: rays of camera depth 1, and what was hit so far."""

    fine: int  # samples per pixel along each side
    rays: Floats  # (h, w, 3)
    depth: Floats  # (h, w) metres along the optical axis
    sunny: Floats  # (h, w, 3)
    shaded: Floats  # (h, w, 3)
    beyond: Flags  # (h, w) not on the open plaza: only there can walls be in the way


class Place:
    """Everything that does not move, prepared once for all cameras."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.floor, self.panorama, self.walls = Floor(scene), Panorama(scene), walls(scene)
        self.sun_map = SunMap(SURROUNDINGS, SHADOW_CELL, scene.sun)
        x, height = scene.parapet
        edge = np.array([[x, -60.0, height], [x, 90.0, height]])
        base = edge * (1, 1, 0)
        self.sun_map.add_polygon(np.concatenate((beam(edge, scene.sun), base[::-1, :2])), height)
        self.props = props(scene, self.sun_map)
        self.shade = self.sun_map.soft_mask(0.02, 0.06)

    def sun_share(self, ground: Floats) -> Floats:
        """How much sun reaches beams meeting the ground at (h, w, 2) metres."""
        cells = self.sun_map.cells(ground)
        return 1 - looked_up(self.shade, cells[..., 0], cells[..., 1], cv2.BORDER_CONSTANT)

    def backdrop(self, camera: Camera) -> Backdrop:
        size = (camera.height, camera.width)
        sunny, shaded = np.empty((*size, 3), np.float32), np.empty((*size, 3), np.float32)
        beams, depth = np.empty((*size, 2), np.float32), np.empty(size, np.float32)
        for top in range(0, camera.height, TILE[0]):
            for left in range(0, camera.width, TILE[1]):
                patch = _Patch(top, left, min(TILE[0], size[0] - top), min(TILE[1], size[1] - left))
                for whole, part in zip((sunny, shaded, beams, depth), self._tile(camera, patch), strict=True):
                    whole[top : top + patch.rows, left : left + patch.columns] = part
        for mesh in self.props:
            sprite = draw(camera, mesh)
            if sprite is not None:
                lay(sunny, sprite, depth)
                lay(shaded, sprite, depth)
        return Backdrop(sunny, shaded, beams)

    def _tile(self, camera: Camera, patch: _Patch) -> tuple[Floats, Floats, Floats, Floats]:
        tile = self._ground(camera, patch)
        if tile.beyond.any():
            rows, columns = np.nonzero(tile.beyond)
            free, rays = (rows, columns), tile.rays[tile.beyond]
            for wall in self.walls:
                if _may_cover(camera, wall, patch):
                    self._wall(camera, wall, tile, free, rays)
            self._distance(tile)
        middle = slice(tile.fine // 2, None, tile.fine)
        rays, near = tile.rays[middle, middle], tile.depth[middle, middle]
        points = camera.centre + rays * near[..., None].astype(np.float64)
        beams = np.where(near[..., None] < FAR, beam(points, self.scene.sun), np.nan)
        return _shrunk(tile.sunny, tile.fine), _shrunk(tile.shaded, tile.fine), beams.astype(np.float32), near

    def _ground(self, camera: Camera, patch: _Patch) -> _Tile:
        """The floor; it blurs its own joints, so one sample a pixel does unless walls come in."""
        rays = _rays(camera, patch, 1)
        x, y, depth = _meeting_ground(camera, rays)
        fine = FINE if (self._beyond(x, y, rays) | (depth > COARSE)).any() else 1
        if fine > 1:
            rays = _rays(camera, patch, fine)
            x, y, depth = _meeting_ground(camera, rays)
        colour = self.floor.colours(_spot(camera, rays, x, y, depth, fine))
        up = np.array([[0.0, 0.0, 1.0]], dtype=np.float32)
        shaded = colour * (skylight(up) * self._openness(x)[..., None])
        share = self.sun_share(np.stack((x, y), axis=-1))
        sunny = shaded + colour * (sunlight(up, self.scene.sun) * share[..., None])
        misty = 1 - np.exp(-depth / np.float32(HAZE_DISTANCE))[..., None]
        sunny, shaded = (light + (HAZE - light) * misty for light in (sunny, shaded))
        depth[(x < self.scene.parapet[0]) | (rays[..., 2] > -1e-4) | (depth > 400)] = FAR
        return _Tile(fine, rays, depth, sunny, shaded, self._beyond(x, y, rays))

    def _beyond(self, x: Floats, y: Floats, rays: Floats) -> Flags:
        """Where rays do not end on the open plaza, a convex place that no wall stands on."""
        scene = self.scene
        open_plaza = (x > scene.parapet[0]) & (x < scene.steps.x)
        open_plaza &= (y > STREET[0]) & (y < scene.paving.north) & (rays[..., 2] < 0)
        return ~open_plaza

    def _distance(self, tile: _Tile) -> None:
        """Fill in what lies far away where nothing near was met."""
        free = tile.depth >= FAR
        if free.any():
            rays = tile.rays[free]
            light = self.panorama.light(rays / np.linalg.norm(rays, axis=1, keepdims=True))
            tile.sunny[free] = tile.shaded[free] = light

    def _openness(self, x: Floats) -> Floats:
        """Steps and parapet take a little sky from the ground at their feet."""
        west = np.exp(-np.maximum(x - np.float32(self.scene.parapet[0]), 0) / 0.5)
        east = np.exp(-np.maximum(np.float32(self.scene.steps.x) - x, 0) / 0.22)
        return 1 - np.float32(0.38) * west - np.float32(0.2) * east

    def _wall(
        self, camera: Camera, wall: Wall, tile: _Tile, free: tuple[Indices, Indices], rays: Floats
    ) -> None:
        normal = wall.normal
        facing = rays @ normal.astype(np.float32)
        distance = np.float32((wall.corner - camera.centre) @ normal) / np.where(facing == 0, 1e-9, facing)
        offset = (camera.centre - wall.corner).astype(np.float32)
        s = (rays @ wall.along.astype(np.float32)) * distance + offset @ wall.along.astype(np.float32)
        h = (rays @ wall.up.astype(np.float32)) * distance + offset @ wall.up.astype(np.float32)
        inside = (
            (facing < 0) & (distance > 0.05) & (s >= 0) & (s <= wall.length) & (h >= 0) & (h <= wall.height)
        )
        hit = np.flatnonzero(inside)
        hit = hit[distance[hit] < tile.depth[free[0][hit], free[1][hit]]]
        if not len(hit):
            return
        size = np.linalg.norm(rays[hit], axis=1) / np.abs(facing[hit])
        blur = distance[hit] / np.float32(camera.matrix[0, 0] * tile.fine) * np.sqrt(size)
        colour, exists = wall.paint(s[hit], h[hit], blur)
        if exists is not None:
            hit, colour = hit[exists], colour[exists]
        points = camera.centre + rays[hit] * distance[hit][:, None].astype(np.float64)
        place = (free[0][hit], free[1][hit])
        tile.depth[place] = distance[hit]
        tile.sunny[place], tile.shaded[place] = self._lit(normal, colour, points, distance[hit])

    def _lit(self, normal: Floats, colour: Floats, points: Floats, distance: Floats) -> tuple[Floats, Floats]:
        """Light (N, 3) of a wall's points with and without the sun."""
        if not len(points):
            return colour, colour
        facing = normal.astype(np.float32)[None]
        shaded = colour * skylight(facing)
        share = self.sun_share(beam(points, self.scene.sun).astype(np.float32))
        sunny = shaded + colour * sunlight(facing, self.scene.sun) * share[:, None]
        misty = 1 - np.exp(-distance / np.float32(HAZE_DISTANCE))[:, None]
        return sunny + (HAZE - sunny) * misty, shaded + (HAZE - shaded) * misty


def lay(light: Floats, sprite: Sprite, depth: Floats | None = None) -> None:
    """Put a sprite over light (H, W, 3); where `depth` says something is nearer, behind it."""
    rows, columns = light.shape[:2]
    height, width = sprite.cover.shape
    top, bottom = max(sprite.top, 0), min(sprite.top + height, rows)
    left, right = max(sprite.left, 0), min(sprite.left + width, columns)
    if top >= bottom or left >= right:
        return
    inner = (
        slice(top - sprite.top, bottom - sprite.top),
        slice(left - sprite.left, right - sprite.left),
    )
    cover, colour = sprite.cover[inner][..., None], sprite.colour[inner]
    if depth is not None:
        free = (depth[top:bottom, left:right] > sprite.depth - 0.3)[..., None]
        cover, colour = cover * free, colour * free
    light[top:bottom, left:right] *= 1 - cover
    light[top:bottom, left:right] += colour


def _rays(camera: Camera, patch: _Patch, fine: int) -> Floats:
    """World directions (rows * fine, columns * fine, 3) of camera depth 1."""
    u = (np.arange(patch.columns * fine) + 0.5) / fine - 0.5 + patch.left
    v = (np.arange(patch.rows * fine) + 0.5) / fine - 0.5 + patch.top
    right = ((u - camera.matrix[0, 2]) / camera.matrix[0, 0]).astype(np.float32)
    down = ((v - camera.matrix[1, 2]) / camera.matrix[1, 1]).astype(np.float32)
    axes = camera.rotation.astype(np.float32)
    return right[None, :, None] * axes[0] + (axes[2] + down[:, None, None] * axes[1])


def _meeting_ground(camera: Camera, rays: Floats) -> tuple[Floats, Floats, Floats]:
    """Ground x and y, metres, and depth of rays (h, w, 3); far away for rays that rise."""
    down = np.minimum(rays[..., 2], np.float32(-1e-5))
    x0, y0, height = camera.centre.astype(np.float32)
    depth = -height / down
    return x0 + depth * rays[..., 0], y0 + depth * rays[..., 1], depth


def _spot(camera: Camera, rays: Floats, x: Floats, y: Floats, depth: Floats, fine: int) -> Spot:
    """What one sample covers on the ground: long away from the camera, narrow across."""
    flat = np.hypot(rays[..., 0], rays[..., 1])
    side = depth / np.float32(camera.matrix[0, 0] * fine)
    deep = side * flat * depth / np.float32(camera.centre[2])
    ahead, across = np.abs(rays[..., 0]) / flat, np.abs(rays[..., 1]) / flat
    return Spot(x, y, side * across + deep * ahead, side * ahead + deep * across)


def _may_cover(camera: Camera, wall: Wall, patch: _Patch) -> bool:
    """Whether a wall can come into a patch: false only if its corners show that it does not."""
    seen = wall.corners() @ camera.rotation.T + camera.tvec
    if (seen[:, 2] < 0.1).any():
        return bool((seen[:, 2] >= 0.1).any())
    u = camera.matrix[0, 0] * seen[:, 0] / seen[:, 2] + camera.matrix[0, 2] - patch.left
    v = camera.matrix[1, 1] * seen[:, 1] / seen[:, 2] + camera.matrix[1, 2] - patch.top
    across = u.max() > -1 and u.min() < patch.columns
    return bool(across and v.max() > -1 and v.min() < patch.rows)


def _shrunk(light: Floats, fine: int) -> Floats:
    size = (light.shape[1] // fine, light.shape[0] // fine)
    return np.asarray(cv2.resize(light, size, interpolation=cv2.INTER_AREA), np.float32)
