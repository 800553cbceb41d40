"""What stands upright around the plaza, as flat surfaces with painted depth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np

from gtm_hit.demo.arrays import Flags, Floats, Indices
from gtm_hit.demo.ground import box_cover, stripes
from gtm_hit.demo.light import linear
from gtm_hit.demo.noise import cloudy, looked_up
from gtm_hit.demo.scene import Hall, Scene, Terrace

# From places (N,) along both sides and a sample's size: colours (N, 3) and which points exist (None: all).
Paint = Callable[[Floats, Floats, Floats], tuple[Floats, Flags | None]]

SANDSTONE, GROUT = linear("9f9480"), linear("756b5a")
DOOR, PANE, FRAME, BRASS = linear("4e2f20"), linear("2b333b"), linear("857c70"), linear("9a8454")
TREAD, RISER, NOSING = linear("a09889"), linear("978f82"), linear("cfcbc0")
CAPSTONE, LEAF = linear("a9a193"), linear("4a5b2c")


@dataclass(frozen=True)
class Wall:
    """A rectangle in the world: a corner, unit vectors along its sides, their lengths, and what is on it."""

    corner: Floats  # (3,) metres
    along: Floats  # (3,) unit
    up: Floats  # (3,) unit
    length: float
    height: float
    paint: Paint

    @property
    def normal(self) -> Floats:
        return np.cross(self.along, self.up)

    def corners(self) -> Floats:
        """(4, 3) metres."""
        across, upwards = self.along * self.length, self.up * self.height
        return self.corner + np.array([0 * across, across, across + upwards, upwards])


NORTH, EAST, UP = np.array([0.0, 1, 0]), np.array([1.0, 0, 0]), np.array([0.0, 0, 1])


def walls(scene: Scene) -> list[Wall]:
    surface = _Grain(scene.rng(11))
    return [
        *_steps(scene, surface),
        _hall(scene.hall, scene.steps.landing, surface),
        _hall_end(scene, surface),
        *_parapet(scene, surface),
        *_cheeks(scene, surface),
        *(_terrace(row, surface) for row in scene.terraces),
        *_greenery(scene),
    ]


class _Grain:
    """Random unevenness of plaster and stone, looked up by metres."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.fine, self.wide = cloudy(rng, (512, 512), 0.6), cloudy(rng, (512, 512), 1.4)
        self.tones = rng.normal(0, 1, (64, 64)).astype(np.float32)

    def __call__(self, s: Floats, h: Floats, blur: Floats) -> Floats:
        fine = self.fine[_index(h, 60), _index(s, 60)] / (1 + np.square(blur / 0.02))
        wide = self.wide[_index(h, 26), _index(s, 26)] / (1 + np.square(blur / 0.2))
        return np.exp(0.09 * fine + 0.09 * wide).astype(np.float32)

    def block(self, column: Floats, row: Floats) -> Floats:
        return self.tones[np.mod(row, 64).astype(int), np.mod(column, 64).astype(int)]


def _index(metres: Floats, per_metre: float) -> Indices:
    return np.mod(metres * np.float32(per_metre), 512).astype(np.int32)


def _smooth(texture: Floats, s: Floats, h: Floats, per_metre: float) -> Floats:
    columns, rows = (np.mod(metres * np.float32(per_metre), 512) for metres in (s, h))
    return looked_up(texture, columns, rows, cv2.BORDER_WRAP)


def _steps(scene: Scene, grain: _Grain) -> list[Wall]:
    steps, found = scene.steps, []
    length = steps.north - steps.south

    def riser(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, None]:
        joints = stripes(s, 1.9, 0.012, blur)
        tone = grain(s, h * 3, blur) * (1 - 0.5 * joints) * (0.78 + 1.5 * h)
        return RISER * tone[:, None], None

    def tread(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, None]:
        joints = stripes(s + 0.7, 1.9, 0.012, blur)
        # `h` runs inwards: paint on the edge, dirt and less sky in the corner below the next riser.
        corner = 1 - 0.32 * np.exp(-np.maximum(steps.tread - h, 0) / 0.07) * (h < steps.tread)
        colour = TREAD * (grain(s, h, blur) * (1 - 0.5 * joints) * corner)[:, None]
        paint = box_cover(h - 0.05, 0.03, blur)[:, None] * 0.8
        return colour + (NOSING - colour) * paint, None

    for index in range(steps.count):
        x, z = steps.x + index * steps.tread, index * steps.rise
        found.append(Wall(np.array([x, steps.north, z]), -NORTH, UP, length, steps.rise, riser))
        deep = steps.tread if index < steps.count - 1 else scene.hall.x - x
        start = np.array([x, steps.north, z + steps.rise])
        found.append(Wall(start, -NORTH, EAST, length, deep, tread))
    return found


def _hall(hall: Hall, base: float, grain: _Grain) -> Wall:
    def paint(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, None]:
        colour = _ashlar(s, h, blur, grain)
        bay = np.floor(s / np.float32(hall.bay))
        x = s - (bay + np.float32(0.5)) * np.float32(hall.bay)
        for level, thick in ((0.55, 0.08), (5.35, 0.28), (9.6, 0.3)):
            band = box_cover(h - np.float32(level), thick, blur)
            colour += (CAPSTONE * 1.02 - colour) * (0.85 * band)[:, None]
            colour *= 1 - 0.45 * box_cover(h - np.float32(level - thick - 0.09), 0.09, blur)[:, None]
        pier = np.abs(np.abs(x) - np.float32(hall.bay / 2)) < 0.34
        colour *= np.where(pier & (h > 0.63) & (h < 5.0), 1.1, 1.0)[:, None].astype(np.float32)
        _arches(colour, x, h, blur, np.mod(bay, 3) == 1)
        return colour, None

    corner = np.array([hall.x, hall.north, base])
    return Wall(corner, -NORTH, UP, hall.north - hall.south, hall.height, paint)


def _ashlar(s: Floats, h: Floats, blur: Floats, grain: _Grain) -> Floats:
    """Courses of sandstone blocks with recessed joints, coarser in the plinth."""
    course = np.floor(h / np.float32(0.52))
    shifted = s + np.mod(course, 2) * np.float32(0.55)
    block = grain.block(np.floor(shifted / np.float32(1.1)), course)
    joints = np.maximum(stripes(h, 0.52, 0.03, blur), stripes(shifted, 1.1, 0.024, blur))
    tone = np.exp(0.11 * block) * grain(s, h, blur) * np.where(h < 0.55, 0.82, 1.0)
    colour = SANDSTONE * tone[:, None].astype(np.float32)
    # Dirt rises from the ground.
    colour *= (1 - 0.25 * np.exp(-h / 0.35))[:, None]
    return colour + (GROUT - colour) * (0.75 * joints)[:, None]


def _arches(colour: Floats, x: Floats, h: Floats, blur: Floats, door: Flags) -> None:
    """Round-headed doors and windows set back into the wall; the sun comes from the south (+x here)."""
    half, spring = np.float32(1.08), np.float32(3.15)
    sill = np.where(door, 0.0, 0.95).astype(np.float32)
    above = np.maximum(h - spring, 0)
    away = np.where(h > spring, np.hypot(x, above), np.abs(x)) - half
    opening = np.clip(-away / np.maximum(blur, 1e-3) + 0.5, 0, 1) * np.clip((h - sill) / blur + 0.5, 0, 1)
    surround = np.clip((0.34 - away) / np.maximum(blur, 1e-3) + 0.5, 0, 1) * (h > sill - 0.2)
    wedges = stripes(np.arctan2(above, x) * half, 0.34, 0.03, blur) * (h > spring)
    moulding = CAPSTONE * (1 - 0.35 * wedges - 0.3 * box_cover(away - 0.3, 0.03, blur))[:, None]
    colour += (moulding - colour) * surround[:, None]
    inside = np.where(door[:, None], _door(x, h, blur), _window(x, h, blur))
    deep = 0.26 + 0.1 * (h > spring)
    shaded = np.clip((away + deep) / 0.06, 0, 1) * ((x > 0) | (h > spring))
    inside = inside * (1 - 0.62 * shaded)[:, None]
    lit_reveal = np.clip((away + 0.16) / 0.04, 0, 1) * (x < 0) * (h < spring)
    inside = inside + (SANDSTONE * 0.9 - inside) * lit_reveal[:, None]
    colour += (inside - colour) * opening[:, None]


def _door(x: Floats, h: Floats, blur: Floats) -> Floats:
    panels = np.maximum(stripes(x - 0.1, 0.5, 0.09, blur), stripes(h - 0.2, 0.85, 0.12, blur))
    colour = DOOR * (0.8 + 0.5 * panels - 0.75 * box_cover(x, 0.02, blur))[:, None]
    colour = (
        colour
        + (BRASS - colour) * (box_cover(np.abs(x) - 0.12, 0.03, blur) * (np.abs(h - 1.1) < 0.2))[:, None]
    )
    fan = (h > 2.75)[:, None]
    return np.where(fan, _window(x, h, blur), colour)


def _window(x: Floats, h: Floats, blur: Floats) -> Floats:
    bars = np.maximum(stripes(x, 0.54, 0.06, blur), stripes(h - 0.25, 0.72, 0.06, blur))
    # Panes reflect the sky, more so higher up, each tilted a little differently.
    tilt = np.mod(np.floor(x / 0.54) * 0.37 + np.floor((h - 0.25) / 0.72) * 0.61, 1)
    pane = PANE * (0.7 + 0.35 * h + 0.9 * tilt)[:, None]
    return pane + (FRAME - pane) * bars[:, None]


def _hall_end(scene: Scene, grain: _Grain) -> Wall:
    hall = scene.hall

    def paint(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, None]:
        return _ashlar(s, h, blur, grain), None

    corner = np.array([hall.x, hall.south, 0.0])
    return Wall(corner, EAST, UP, 30.0, hall.height, paint)


def _parapet(scene: Scene, grain: _Grain) -> list[Wall]:
    x, height = scene.parapet
    south, north = scene.paving.south, scene.paving.north

    def face(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, None]:
        cap = np.clip((h - np.float32(height - 0.14)) / blur + 0.5, 0, 1)
        joints = np.maximum(stripes(s, 1.3, 0.02, blur), stripes(h, 0.4, 0.02, blur) * (1 - cap))
        tone = grain(s, h, blur) * (1 - 0.45 * joints) * (1 - 0.35 * np.exp(-h / 0.12))
        colour = (SANDSTONE * 0.8 + (CAPSTONE - SANDSTONE * 0.8) * cap[:, None]) * tone[:, None]
        colour *= 1 - 0.4 * box_cover(h - np.float32(height - 0.17), 0.03, blur)[:, None]
        return colour.astype(np.float32), None

    def top(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, None]:
        return CAPSTONE * (grain(s, h, blur) * (1 - 0.4 * stripes(s, 1.3, 0.02, blur)))[:, None], None

    start = np.array([x, south, 0.0])
    return [
        Wall(start, NORTH, UP, north - south, height, face),
        Wall(start + height * UP, NORTH, -EAST, north - south, 0.4, top),
    ]


def _cheeks(scene: Scene, grain: _Grain) -> list[Wall]:
    """Stone blocks that close the steps at both ends."""
    steps, thick, height = scene.steps, 1.2, scene.steps.landing + 0.35
    deep = scene.hall.x - steps.x

    def stone(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, None]:
        joints = np.maximum(stripes(s, 1.2, 0.02, blur), stripes(h, 0.52, 0.02, blur))
        return CAPSTONE * (0.92 * grain(s, h, blur) * (1 - 0.4 * joints))[:, None], None

    found = []
    for south in (steps.south - thick, steps.north):
        west = np.array([steps.x, south + thick, 0.0])
        found += [
            Wall(west, -NORTH, UP, thick, height, stone),
            Wall(np.array([steps.x, south, 0.0]), EAST, UP, deep, height, stone),
            Wall(np.array([scene.hall.x, south + thick, 0.0]), -EAST, UP, deep, height, stone),
            Wall(np.array([steps.x, south + thick, height]), -NORTH, EAST, thick, deep, stone),
        ]
    return found


def _terrace(row: Terrace, grain: _Grain) -> Wall:
    start, end = np.array([row.x0, row.y0, 0.0]), np.array([row.x1, row.y1, 0.0])
    length = float(np.linalg.norm(end - start))
    # Seen from the plaza the front must face it: from left to right along the wall.
    along = (end - start) / length
    plaster = np.array(row.tint, dtype=np.float32) ** np.float32(2.0)

    def paint(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, None]:
        house = np.floor(s / np.float32(3 * row.bay))
        tone = np.exp(0.22 * grain.block(house, house * 0 + 5)) * grain(s, h, blur)
        warm = 1 + 0.07 * grain.block(house, house * 0 + 9)
        colour = plaster * tone[:, None]
        colour[:, 2] *= warm
        x = s - (np.floor(s / np.float32(row.bay)) + np.float32(0.5)) * np.float32(row.bay)
        _shopfronts(colour, x, h, blur, grain, house)
        level = np.mod(h - 4.6, 3.4)
        window = (np.abs(x) < 0.62) & (level > 0.6) & (level < 2.5) & (h > 4.6)
        surround = (np.abs(x) < 0.78) & (level > 0.45) & (level < 2.66) & (h > 4.6)
        colour[surround] = CAPSTONE * np.float32(1.05)
        colour[window] = PANE * np.float32(1.5)
        return colour.astype(np.float32), None

    return Wall(start, along, UP, length, row.height, paint)


def _shopfronts(colour: Floats, x: Floats, h: Floats, blur: Floats, grain: _Grain, house: Floats) -> None:
    awning_tone = grain.block(house, house * 0 + 21)
    glass = (np.abs(x) < 1.35) & (h > 0.5) & (h < 2.7)
    colour[(np.abs(x) < 1.5) & (h < 2.9)] = FRAME * np.float32(0.5)
    pane = PANE * (0.7 + 0.5 * h + 0.3 * np.sin(x * 3 + house))[:, None]
    colour[glass] = pane[glass]
    display = np.clip(1 - np.abs(h - 1.1) / 0.7, 0, 1) * np.clip(
        grain(x * 5 + house, h * 4, blur) - 0.95, 0, 1
    )
    colour[glass] += (display[:, None] * linear("e8b878") * np.float32(1.4))[glass]
    mirrored = np.mod(x * 0.8 + h * 0.55 + house * 0.37, 1.3) < 0.42
    colour[glass & mirrored] *= 1.7
    mullion = box_cover(np.abs(x) - np.float32(0.45), 0.04, blur) * glass
    colour += (FRAME * np.float32(0.5) - colour) * mullion[:, None]
    awning = (np.abs(x) < 1.6) & (h > 2.7) & (h < 3.35)
    shades = np.array([linear("8e2f27"), linear("2f4f45"), linear("c9bda2"), linear("31405c")])
    chosen = shades[np.mod(np.round(awning_tone * 3), 4).astype(int)]
    colour[awning] = (chosen * (0.7 + 0.5 * (3.35 - h))[:, None])[awning]
    fascia = box_cover(h - np.float32(3.75), 0.25, blur)[:, None]
    colour += (CAPSTONE * np.float32(0.9) - colour) * 0.6 * fascia


def _greenery(scene: Scene) -> list[Wall]:
    """A clipped hedge behind the parapet and the crowns of trees on the slope below it."""
    rng = scene.rng(12)
    leaves, clumps = cloudy(rng, (512, 512), 0.8), cloudy(rng, (512, 512), 1.7)

    def foliage(bottom: float, top: float, ragged: float, scale: float, tone: float) -> Paint:
        def paint(s: Floats, h: Floats, blur: Floats) -> tuple[Floats, Flags]:
            mass = _smooth(clumps, s, h, 24 / scale)
            leaf = _smooth(leaves, s, h, 90 / scale) / (1 + np.square(blur / 0.05))
            skyline = top - bottom - ragged * (1.0 + _smooth(clumps, s, s * 0 + 0.3, 16 / scale))
            exists = h + 0.3 * ragged * leaf + 0.6 * ragged * mass < skyline
            depth = np.clip(h / np.maximum(skyline, 0.1), 0, 1)
            light = tone * np.exp(0.26 * leaf + 0.42 * mass) * (0.55 + 0.75 * depth)
            colour = LEAF * light[:, None]
            colour[:, 0] *= 1 + 0.12 * mass
            return colour.astype(np.float32), exists

        return paint

    x = scene.parapet[0]
    south, north = scene.paving.south - 25, scene.paving.north + 30
    return [
        Wall(
            np.array([x - 0.9, south, 0.0]), NORTH, UP, north - south, 1.9, foliage(0, 1.75, 0.09, 1.0, 1.5)
        ),
        Wall(np.array([x - 9, south, -6.0]), NORTH, UP, north - south, 13.0, foliage(-6, 6.6, 1.7, 4.0, 1.6)),
    ]
