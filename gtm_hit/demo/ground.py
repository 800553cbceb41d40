"""The plaza's floor: slabs with joints, an inlaid rose, covers, light wells, the street beyond."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from gtm_hit.demo.arrays import Floats
from gtm_hit.demo.light import linear
from gtm_hit.demo.noise import cloudy, looked_up
from gtm_hit.demo.scene import Scene

Window = tuple[slice, slice]

STONE, BAND, DARK_STONE = linear("988f82"), linear("a89f90"), linear("625e59")
ROSE_PALE = linear("a3705c")
JOINT, ASPHALT, PAINT = linear("4a4640"), linear("6a6b6d"), linear("d9d6cd")
GUIDE, IRON, GLASS = linear("b9aa84"), linear("4b4947"), linear("7b8a83")
STREET = (-39.0, -24.6)  # from y to y
NOISE_SIDE = 1024


@dataclass(frozen=True)
class Spot:
    """Points of the floor and what one sample of a picture covers there."""

    x: Floats  # (h, w) metres
    y: Floats
    wide: Floats  # metres along X
    long: Floats  # metres along Y

    @property
    def blur(self) -> Floats:
        return np.sqrt(self.wide * self.long)

    def part(self, window: Window) -> Spot:
        return Spot(self.x[window], self.y[window], self.wide[window], self.long[window])


def box_cover(offset: Floats, half_width: float, blur: Floats) -> Floats:
    """Share of a sample, `blur` wide, that lies within `half_width` of a line it is `offset` away from.

    The exact integral, which is what keeps thin joints from flickering in the distance.
    """
    reach = blur / 2
    inside = np.minimum(offset + reach, half_width) - np.maximum(offset - reach, -half_width)
    return np.clip(inside / np.maximum(blur, 1e-6), 0, 1)


def stripes(along: Floats, period: float, width: float, blur: Floats) -> Floats:
    """Share of each sample covered by lines of a width that repeat with a period."""
    offset = along - np.round(along / period) * np.float32(period)
    cover = box_cover(offset, width / 2, blur)
    far = np.clip(blur / np.float32(period * 0.6) - 1, 0, 1)
    return cover + (np.float32(width / period) - cover) * far


def _near(spot: Spot, x: float, y: float, reach: float) -> Window | None:
    """The rows and columns of samples that come within reach of a place."""
    close = (np.abs(spot.x - np.float32(x)) < reach) & (np.abs(spot.y - np.float32(y)) < reach)
    rows, columns = np.flatnonzero(close.any(axis=1)), np.flatnonzero(close.any(axis=0))
    if not len(rows):
        return None
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)


class Floor:
    """Colours of the ground, anywhere."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.paving = scene, scene.paving
        rng = scene.rng(10)
        side = (NOISE_SIDE, NOISE_SIDE)
        self._grain = cloudy(rng, side, 0.55)
        self._stain = cloudy(rng, side, 1.35)
        self._tones = rng.normal(0, 1, (256, 256)).astype(np.float32)
        self._tints = rng.normal(0, 1, (256, 256)).astype(np.float32)

    def colours(self, spot: Spot) -> Floats:
        """Albedo (h, w, 3)."""
        colour = self._slabs(spot)
        self._rose(spot, colour)
        self._wear(spot, colour)
        self._details(spot, colour)
        self._surroundings(spot, colour)
        return colour

    def texture(self, which: Floats, spot: Spot, metres: float, feature: float) -> Floats:
        """Noise that repeats every `metres`, fading where samples are larger than its features."""
        scale = np.float32(NOISE_SIDE / metres)
        columns, rows = (np.mod(places * scale, NOISE_SIDE) for places in (spot.x, spot.y))
        values = looked_up(which, columns, rows, cv2.BORDER_WRAP)
        return values / (1 + np.square(spot.blur / np.float32(feature)))

    def _slabs(self, spot: Spot) -> Floats:
        paving = self.paving
        field = np.float32(paving.field)
        column, row = np.floor(spot.x / field), np.floor(spot.y / field)
        # Fields between the bands are laid lengthwise and crosswise by turns.
        crosswise = np.mod(column + row, 2) < 1
        x, y = spot.x - column * field, spot.y - row * field
        across, along = np.where(crosswise, x, y), np.where(crosswise, y, x)
        blur_across = np.where(crosswise, spot.wide, spot.long)
        blur_along = np.where(crosswise, spot.long, spot.wide)
        course = np.floor(across / np.float32(paving.course))
        shifted = along + np.mod(course * np.float32(0.618), 1) * np.float32(paving.slab)
        slab = np.floor(shifted / np.float32(paving.slab))
        joints = stripes(across, paving.course, paving.joint, blur_across)
        joints = np.maximum(joints, stripes(shifted, paving.slab, paving.joint, blur_along))
        tone, tint = self._tone(course + column * 7, slab + row * 13, spot, paving.slab)
        colour = STONE * np.exp(0.07 * tone)[..., None]
        colour[..., 0] *= 1 + 0.016 * tint
        colour[..., 2] *= 1 - 0.022 * tint
        colour += (JOINT - colour) * (0.85 * joints)[..., None]
        return self._bands(spot, x, y, colour)

    def _tone(self, column: Floats, row: Floats, spot: Spot, size: float) -> tuple[Floats, Floats]:
        """Every slab's own tone and tint."""
        place = (np.mod(column, 256).astype(np.int32), np.mod(row, 256).astype(np.int32))
        near = 1 / (1 + np.square(spot.blur / np.float32(size)))
        return self._tones[place] * near, self._tints[place] * near

    def _bands(self, spot: Spot, x: Floats, y: Floats, colour: Floats) -> Floats:
        paving, half = self.paving, np.float32(self.paving.band / 2)
        for offset, other, blur, blur_other in ((x, y, spot.wide, spot.long), (y, x, spot.long, spot.wide)):
            from_line = np.minimum(offset, paving.field - offset)
            band = box_cover(from_line, float(half), blur)
            edge = box_cover(from_line - half, paving.joint / 2, blur)
            colour += (BAND - colour) * band[..., None]
            cuts = stripes(other, paving.field / 5, paving.joint, blur_other) * band
            colour += (JOINT - colour) * (0.8 * np.maximum(edge, cuts))[..., None]
        return colour

    def _rose(self, spot: Spot, colour: Floats) -> None:
        """A star in a ring of dark stone, the plaza's middle."""
        x0, y0, radius = self.paving.rose
        near = _near(spot, x0, y0, radius + 0.2)
        if near is None:
            return
        spot, colour = spot.part(near), colour[near]
        x, y = spot.x - np.float32(x0), spot.y - np.float32(y0)
        away = np.hypot(x, y)
        angle = np.arctan2(y, x)
        inside = np.clip((radius - away) / np.maximum(spot.blur, 1e-4) + 0.5, 0, 1)
        colour += (BAND - colour) * inside[..., None]
        ring = box_cover(away - np.float32(radius - 0.2), 0.2, spot.blur)
        ring = np.maximum(ring, box_cover(away - np.float32(radius * 0.46), 0.05, spot.blur))
        colour += (DARK_STONE - colour) * ring[..., None]
        for turn, reach, waist in ((np.pi / 8, 0.66, 0.3), (0.0, 0.86, 0.36)):
            _star(colour, away, angle + np.float32(turn), spot.blur, radius * reach, radius * waist)
        joints = box_cover(away - np.float32(radius), 0.008, spot.blur)
        for circle in (0.7, 0.84):
            joints = np.maximum(joints, box_cover(away - np.float32(radius * circle), 0.006, spot.blur))
        colour += (JOINT - colour) * (0.7 * joints)[..., None]

    def _wear(self, spot: Spot, colour: Floats) -> None:
        """Grain of the stone, weather, and where people drop things."""
        grain = self.texture(self._grain, spot, 2.9, 0.012)
        coarse = self.texture(self._grain, spot, 13.0, 0.06)
        stains = self.texture(self._stain, spot, 9.7, 0.4)
        weather = self.texture(self._stain, spot, 41.0, 2.0)
        gum = np.clip((self.texture(self._grain, spot, 17.0, 0.05) - 2.75) * 2, 0, 1)
        tone = np.exp(0.085 * grain + 0.06 * coarse + 0.075 * stains + 0.085 * weather) * (1 - 0.4 * gum)
        colour *= tone[..., None]

    def _details(self, spot: Spot, colour: Floats) -> None:
        for x, y in self.paving.covers:
            self._cover(spot, colour, x, y)
        for x0, y0, x1, y1 in self.paving.light_wells:
            self._light_well(spot, colour, x0, y0, x1, y1)
        drain = box_cover(spot.x - np.float32(self.paving.drain_x), 0.05, spot.wide)
        slots = stripes(spot.y, 0.036, 0.016, spot.long)
        colour += (IRON * (1.5 - slots[..., None]) - colour) * drain[..., None]
        steps = self.scene.steps
        guide_x = np.float32(steps.x - 0.42)
        guide = box_cover(spot.x - guide_x, 0.15, spot.wide)
        guide *= (spot.y > steps.south) & (spot.y < steps.north)
        ridges = stripes(spot.x - guide_x, 0.06, 0.03, spot.wide)
        colour += (GUIDE * (0.78 + 0.3 * ridges[..., None]) - colour) * (0.9 * guide)[..., None]

    def _cover(self, spot: Spot, colour: Floats, x: float, y: float) -> None:
        """A round iron manhole cover."""
        near = _near(spot, x, y, 0.5)
        if near is None:
            return
        spot, colour = spot.part(near), colour[near]
        away = np.hypot(spot.x - np.float32(x), spot.y - np.float32(y))
        disc = np.clip((0.33 - away) / np.maximum(spot.blur, 1e-4) + 0.5, 0, 1)
        rim = box_cover(away - np.float32(0.30), 0.02, spot.blur)
        studs = stripes(spot.x, 0.08, 0.04, spot.wide) * stripes(spot.y, 0.08, 0.04, spot.long)
        iron = IRON * (1 + 0.9 * studs + 0.9 * rim)[..., None]
        colour += (iron - colour) * disc[..., None]

    def _light_well(self, spot: Spot, colour: Floats, x0: float, y0: float, x1: float, y1: float) -> None:
        """Glass bricks in a concrete frame that light a room below."""
        near = _near(spot, (x0 + x1) / 2, (y0 + y1) / 2, max(x1 - x0, y1 - y0) / 2 + 0.3)
        if near is None:
            return
        spot, colour = spot.part(near), colour[near]
        x, y = spot.x - np.float32(x0), spot.y - np.float32(y0)
        inside = box_cover(x - np.float32((x1 - x0) / 2), (x1 - x0) / 2, spot.wide)
        inside *= box_cover(y - np.float32((y1 - y0) / 2), (y1 - y0) / 2, spot.long)
        bars = 1 - (1 - stripes(x, 0.2, 0.055, spot.wide)) * (1 - stripes(y, 0.2, 0.055, spot.long))
        lens = np.mod(x / 0.2, 1) * 0.4 + np.mod(y / 0.2, 1) * 0.3
        glass = GLASS * (0.62 + lens / (1 + np.square(spot.blur / 0.2)))[..., None]
        well = glass + (BAND * np.float32(0.95) - glass) * bars[..., None]
        colour += (well - colour) * inside[..., None]

    def _surroundings(self, spot: Spot, colour: Floats) -> None:
        paving = self.paving
        south, north = np.float32(paving.south), np.float32(paving.north)
        edge = np.clip((south - spot.y) / np.maximum(spot.long, 0.02) + 0.5, 0, 1)
        if edge.max() > 0:
            street = self._street(spot)
            colour += (street - colour) * edge[..., None]
        beyond = np.clip((spot.y - north) / np.maximum(spot.long, 0.02) + 0.5, 0, 1)
        if beyond.max() > 0:
            colour += (STONE * np.float32(0.8) - colour) * beyond[..., None]
        for line in (south, north):
            kerb = box_cover(spot.y - line, 0.16, spot.long)
            colour += (BAND * np.float32(1.12) - colour) * kerb[..., None]

    def _street(self, spot: Spot) -> Floats:
        grain = self.texture(self._grain, spot, 5.3, 0.02)
        road = (spot.y > STREET[0]) & (spot.y < STREET[1])
        base = np.where(road[..., None], ASPHALT, STONE * np.float32(0.85))
        colour = base * np.exp(0.08 * grain)[..., None]
        middle = box_cover(spot.y - np.float32(sum(STREET) / 2), 0.07, spot.long)
        dashes = np.mod(spot.x, 6.0) < 3.0
        colour += (PAINT - colour) * (middle * dashes)[..., None]
        return colour.astype(np.float32)


def _star(colour: Floats, away: Floats, angle: Floats, blur: Floats, reach: float, waist: float) -> None:
    """Lay eight points, one half of each dark and one half pale; between two the star is `waist` wide."""
    sector = np.float32(np.pi / 4)
    offset = angle - np.round(angle / sector) * sector
    ahead, aside = away * np.cos(offset), away * np.sin(offset)
    inner_x, inner_y = waist * np.cos(np.pi / 8) * 0.6, waist * np.sin(np.pi / 8) * 0.6
    # Distance to the edge from the tip (reach, 0) to the inner corner.
    slope = np.array([inner_y, reach - inner_x]) / np.hypot(inner_y, reach - inner_x)
    edge = (np.float32(reach) - ahead) * np.float32(slope[0]) - np.abs(aside) * np.float32(slope[1])
    cover = np.clip(edge / np.maximum(blur, 1e-4) + 0.5, 0, 1)
    dark = np.clip(aside / np.maximum(blur, 1e-4) + 0.5, 0, 1)[..., None]
    colour += (ROSE_PALE + (DARK_STONE - ROSE_PALE) * dark - colour) * cover[..., None]
