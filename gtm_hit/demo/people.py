"""The people of the demo scene as lit surfaces in the world."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from gtm_hit.demo.arrays import Bytes, Floats
from gtm_hit.demo.body import body
from gtm_hit.demo.light import skylight, sunlight
from gtm_hit.demo.loft import normals
from gtm_hit.demo.noise import looked_up
from gtm_hit.demo.pose import NORMAL_HEIGHT, pose
from gtm_hit.demo.scene import Area, Scene
from gtm_hit.demo.shadows import SunMap, beam
from gtm_hit.demo.splat import Mesh
from gtm_hit.demo.walks import Walks, make_walks
from gtm_hit.demo.wardrobe import Look, dress_everybody

SHADOW_CELL = 0.02  # metres
SHADOW_REACH = 7.0  # metres around the grid on which people's shadows are kept
CONTACT_HEIGHT = 0.22  # metres; what is lower keeps skylight from the ground beneath it


@dataclass(frozen=True)
class Cast:
    """Who walks through the scene, and how they look."""

    scene: Scene
    walks: Walks
    looks: list[Look]

    @classmethod
    def of(cls, scene: Scene) -> Cast:
        walks = make_walks(scene, scene.rng(1))
        return cls(scene, walks, dress_everybody(walks, scene.rng(2)))


@dataclass(frozen=True)
class Moment:
    """Everybody in one frame, and the map of the shadows they cast."""

    meshes: list[Mesh]
    sun_map: SunMap

    @cached_property
    def shadow(self) -> Bytes:
        """(rows, columns, 2) of the sun map: how much sun and how much sky people take, 0…255."""
        cell = self.sun_map.cell
        sun = self.sun_map.soft_mask(0.009, 0.024)
        low = (self.sun_map.top > 0) & (self.sun_map.top < CONTACT_HEIGHT)
        sky = cv2.GaussianBlur(low.astype(np.float32), (0, 0), 0.05 / cell)
        wide = cv2.GaussianBlur((self.sun_map.top > 0).astype(np.float32), (0, 0), 0.16 / cell)
        sky = np.clip(1.25 * sky + 0.12 * wide, 0, 1)
        return (np.stack((sun, sky), axis=-1) * 255).astype(np.uint8)


def moment(cast: Cast, frame: int, shade: tuple[SunMap, Floats] | None = None) -> Moment:
    """Everybody in the frame with this index; `shade` is the place's own sun map and its soft mask."""
    scene = cast.scene
    sun_map = SunMap(shadow_area(scene), SHADOW_CELL, scene.sun)
    meshes = [_figure(cast, frame, person) for person in range(cast.walks.people)]
    for mesh in meshes:
        sun_map.add(mesh)
    return Moment([_lit(mesh, scene, sun_map, shade) for mesh in meshes], sun_map)


def shadow_area(scene: Scene) -> Area:
    grid, reach = scene.grid, SHADOW_REACH
    width, length = grid.extent
    return Area(
        grid.origin_x - reach,
        grid.origin_x + width + reach,
        grid.origin_y - reach,
        grid.origin_y + length + reach,
    )


def _figure(cast: Cast, frame: int, person: int) -> Mesh:
    """One person where the walk says, not lit yet."""
    walks, look = cast.walks, cast.looks[person]
    standing = pose(
        float(walks.phase[frame, person]), float(walks.speed[person]), look.arms, walks.gaze[person]
    )
    parts = body(look, standing, float(walks.build[person]))
    heading = walks.heading[frame, person]
    turn = np.array(
        [[np.cos(heading), np.sin(heading), 0], [-np.sin(heading), np.cos(heading), 0], [0, 0, 1]]
    )
    scale = walks.height[person] / NORMAL_HEIGHT
    where = np.array([*walks.xy[frame, person], 0.0])
    vertices = np.concatenate([part.points.reshape(-1, 3) for part in parts]) @ turn * scale + where
    directions = np.concatenate([normals(part.points).reshape(-1, 3) for part in parts]) @ turn
    return Mesh(tuple(parts), vertices, directions, np.zeros(vertices.shape, np.float32))


def _lit(mesh: Mesh, scene: Scene, sun_map: SunMap, shade: tuple[SunMap, Floats] | None) -> Mesh:
    facing = mesh.normals.astype(np.float32)
    reaches = sun_map.reaches(mesh.vertices)
    if shade is not None:
        cells = shade[0].cells(beam(mesh.vertices, scene.sun))
        reaches = reaches * (1 - looked_up(shade[1], cells[:, 0], cells[:, 1], cv2.BORDER_CONSTANT))
    low = np.exp(-np.maximum(mesh.vertices[:, 2:], 0) / 0.3).astype(np.float32)
    light = skylight(facing) * (1 - 0.35 * low) + sunlight(facing, scene.sun) * reaches[:, None]
    return Mesh(mesh.parts, mesh.vertices, mesh.normals, light.astype(np.float32))
