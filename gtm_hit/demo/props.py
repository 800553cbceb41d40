"""Street furniture and trees around the plaza."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gtm_hit.demo.arrays import Floats
from gtm_hit.demo.light import linear, skylight, sunlight
from gtm_hit.demo.loft import Part, ball, box, loft, normals
from gtm_hit.demo.noise import cloudy
from gtm_hit.demo.scene import Scene
from gtm_hit.demo.shadows import SunMap
from gtm_hit.demo.splat import Mesh

LEFT, FRONT, UP = np.array([0.0, 1, 0]), np.array([1.0, 0, 0]), np.array([0.0, 0, 1])
CONCRETE, SOIL, LEAF, BARK = linear("b3aca0"), linear("4b3a2b"), linear("4f6a2c"), linear("5d5145")
TIMBER, STEEL, LACQUER, LANTERN = linear("8f6743"), linear("8c8f92"), linear("23302b"), linear("efeadb")


def props(scene: Scene, sun_map: SunMap) -> list[Mesh]:
    """All furniture, lit; its shadows are added to the map."""
    rng = scene.rng(14)
    rough = np.exp(0.12 * cloudy(rng, (96, 96), 0.8))
    things = _things(scene, rng, rough.astype(np.float32))
    meshes = [_mesh(parts) for parts in things]
    for mesh in meshes:
        sun_map.add(mesh)
    return [_lit(mesh, scene, sun_map) for mesh in meshes]


def _things(scene: Scene, rng: np.random.Generator, rough: Floats) -> list[list[Part]]:
    furniture = scene.furniture
    things = [_planter(x, y, rng, rough) for x, y in furniture.planters]
    things += [_bench(x, y, turn, rough) for x, y, turn in furniture.benches]
    things += [_bin(x, y, rough) for x, y in furniture.bins]
    things += [_lamp(x, y, scene.steps.landing if x > scene.steps.x else 0.0) for x, y in furniture.lamps]
    things += [_parasol(x, y, colour, rough) for x, y, colour in furniture.parasols]
    things += [_bollard(x, y) for x, y in furniture.bollards]
    things += [_trunk(x, y, rough) for x, y in furniture.trees]
    things += [_crown(x, y, rng, rough) for x, y in furniture.trees]
    return things


def _mesh(parts: list[Part]) -> Mesh:
    vertices = np.concatenate([part.points.reshape(-1, 3) for part in parts])
    directions = np.concatenate([normals(part.points).reshape(-1, 3) for part in parts])
    dark = np.zeros_like(vertices, dtype=np.float32)
    return Mesh(tuple(parts), vertices, directions, dark)


def _lit(mesh: Mesh, scene: Scene, sun_map: SunMap) -> Mesh:
    facing = mesh.normals.astype(np.float32)
    low = np.exp(-np.maximum(mesh.vertices[:, 2:], 0) / 0.15).astype(np.float32)
    shade = skylight(facing) * (1 - 0.4 * low)
    light = shade + sunlight(facing, scene.sun) * sun_map.reaches(mesh.vertices)[:, None]
    return replace(mesh, light=light.astype(np.float32))


def turned(outline: list[tuple[float, float]], x: float, y: float, z: float = 0.0) -> Floats:
    """A surface of revolution about the vertical at (x, y), from (height, radius) pairs."""
    heights, radii = np.array(outline).T
    centres = np.array([x, y, z]) + heights[:, None] * UP
    return loft(centres, LEFT, FRONT, radii, radii, sectors=24)


def _planter(x: float, y: float, rng: np.random.Generator, rough: Floats) -> list[Part]:
    """A wide concrete pot with a round shrub, like a drum that narrows upwards."""
    pot = turned(
        [(0, 0.7), (0.02, 0.98), (0.1, 1.0), (0.62, 0.86), (0.66, 0.82), (0.66, 0.74), (0.6, 0.7)], x, y
    )
    soil = turned([(0.56, 0.74), (0.6, 0.5), (0.61, 0.01)], x, y)
    found = [Part(pot, CONCRETE * rough[..., None]), Part(soil, SOIL * rough[..., None])]
    for _ in range(9):
        middle = np.array([x, y, 0.0]) + np.append(rng.normal(0, 0.3, 2), rng.uniform(0.66, 0.95))
        size = rng.uniform(0.2, 0.36, 3)
        found.append(Part(ball(middle, LEFT, FRONT, UP, size), _foliage(rng, rough)))
    return found


def _foliage(rng: np.random.Generator, rough: Floats) -> Floats:
    tone = np.roll(rough, rng.integers(0, 96, 2).tolist(), axis=(0, 1)) ** 4
    tint = np.array([1 + rng.normal(0, 0.12), 1, 0.9], dtype=np.float32)
    return (LEAF * tint * np.float32(rng.uniform(0.6, 1.15)) * tone[..., None]).astype(np.float32)


def _bench(x: float, y: float, turn: float, rough: Floats) -> list[Part]:
    angle = np.radians(turn)
    along = np.array([np.cos(angle), np.sin(angle), 0.0])
    across = np.array([-np.sin(angle), np.cos(angle), 0.0])
    middle = np.array([x, y, 0.0])
    wood, stone = TIMBER * rough[..., None], CONCRETE * rough[..., None]
    found = [
        Part(box(middle + shift * across + 0.45 * UP, along, across, UP, (1.0, 0.055, 0.03)), wood)
        for shift in (-0.19, -0.065, 0.065, 0.19)
    ]
    found += [
        Part(box(middle + shift * along + 0.2 * UP, along, across, UP, (0.09, 0.22, 0.22)), stone)
        for shift in (-0.7, 0.7)
    ]
    return found


def _bin(x: float, y: float, rough: Floats) -> list[Part]:
    drum = turned(
        [(0, 0.01), (0.0, 0.2), (0.05, 0.23), (0.8, 0.24), (0.82, 0.26), (0.88, 0.26), (0.92, 0.0)], x, y
    )
    colours = STEEL * rough[..., None] * np.float32(0.9)
    colours[70:80, 36:60] = 0.01  # the slot
    return [Part(drum, colours)]


def _lamp(x: float, y: float, base: float) -> list[Part]:
    outline = [(0, 0.01), (0, 0.16), (0.25, 0.15), (0.4, 0.09), (1.0, 0.07), (4.2, 0.05), (4.3, 0.13)]
    pole = turned([*outline, (4.35, 0.01)], x, y, base)
    globe = ball(np.array([x, y, base + 4.55]), LEFT, FRONT, UP, (0.23, 0.23, 0.26))
    return [
        Part(pole, np.broadcast_to(LACQUER, (8, 8, 3)).copy()),
        Part(globe, np.broadcast_to(LANTERN, (8, 8, 3)).copy()),
    ]


def _parasol(x: float, y: float, colour: str, rough: Floats) -> list[Part]:
    cloth = linear(colour) * rough[..., None] ** np.float32(0.3)
    cloth[:, ::12] *= 0.8
    found = [
        Part(turned([(2.15, 1.6), (2.2, 1.62), (2.3, 1.5), (2.75, 0.25), (2.8, 0.01)], x, y), cloth),
        Part(turned([(0, 0.28), (0.08, 0.28), (0.1, 0.03), (2.7, 0.03)], x, y), STEEL * rough[..., None]),
        Part(
            turned([(0.0, 0.2), (0.03, 0.2), (0.05, 0.03), (0.7, 0.03)], x + 0.7, y),
            LACQUER * rough[..., None],
        ),
        Part(
            turned([(0.7, 0.01), (0.7, 0.4), (0.74, 0.4), (0.74, 0.01)], x + 0.7, y),
            CONCRETE * rough[..., None],
        ),
    ]
    for angle in (0.4, 2.2, 4.0):
        seat = np.array([x + 0.7 + 0.75 * np.cos(angle), y + 0.75 * np.sin(angle), 0.0])
        out = np.array([np.cos(angle), np.sin(angle), 0.0])
        side = np.array([-out[1], out[0], 0.0])
        found.append(
            Part(box(seat + 0.44 * UP, side, out, UP, (0.21, 0.21, 0.03)), TIMBER * rough[..., None])
        )
        found.append(
            Part(
                box(seat + 0.2 * out + 0.64 * UP, side, out, UP, (0.2, 0.02, 0.2)), TIMBER * rough[..., None]
            )
        )
        found.append(
            Part(
                turned([(0, 0.16), (0.02, 0.16), (0.44, 0.14)], seat[0], seat[1]), LACQUER * rough[..., None]
            )
        )
    return found


def _bollard(x: float, y: float) -> list[Part]:
    outline = [(0, 0.01), (0, 0.1), (0.06, 0.08), (0.8, 0.07), (0.86, 0.09), (0.92, 0.07), (0.95, 0.0)]
    return [Part(turned(outline, x, y), np.broadcast_to(LACQUER, (8, 8, 3)).copy())]


def _trunk(x: float, y: float, rough: Floats) -> list[Part]:
    outline = [(0, 0.3), (0.1, 0.24), (0.5, 0.19), (2.6, 0.15), (4.2, 0.12), (5.5, 0.05)]
    bark = BARK * np.roll(rough, 17, axis=0)[..., None] ** np.float32(2)
    return [Part(turned(outline, x, y), bark.astype(np.float32))]


def _crown(x: float, y: float, rng: np.random.Generator, rough: Floats) -> list[Part]:
    """A plane tree's leaves: many clumps with gaps, which is what dapples the ground."""
    found = []
    for _ in range(130):
        away = rng.normal(0, 1, 3)
        away *= rng.uniform(0.3, 1.0) ** 0.5 / np.linalg.norm(away)
        middle = np.array([x, y, 5.7]) + away * (2.5, 2.5, 2.0)
        found.append(Part(ball(middle, LEFT, FRONT, UP, rng.uniform(0.12, 0.42, 3), 7), _foliage(rng, rough)))
    return found
