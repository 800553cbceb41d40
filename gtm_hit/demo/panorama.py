"""What lies beyond the plaza: sky, hazy hills and the roofs of a town."""

from __future__ import annotations

import numpy as np

from gtm_hit.demo.arrays import Floats
from gtm_hit.demo.light import linear
from gtm_hit.demo.noise import cloudy
from gtm_hit.demo.scene import Scene

ZENITH, HORIZON = np.array([0.30, 0.52, 0.98], np.float32), np.array([0.92, 1.10, 1.34], np.float32)
AIR = np.array([0.62, 0.78, 1.0], dtype=np.float32)  # haze over the distance, bluer than that nearby
HILL, ROOF, HOUSE, WOOD = linear("7f93a8"), linear("9c6d58"), linear("c9bda8"), linear("4f5d3c")


class Panorama:
    """Light that comes from directions in which nothing near is."""

    def __init__(self, scene: Scene) -> None:
        rng = scene.rng(13)
        self.ridge, self.clouds = cloudy(rng, (4, 2048), 1.5)[0], cloudy(rng, (256, 1024), 1.6)
        self.houses = rng.random((2, 4096)).astype(np.float32)

    def light(self, directions: Floats) -> Floats:
        """Light (N, 3) from unit directions (N, 3)."""
        turn = np.mod(np.arctan2(directions[:, 1], directions[:, 0]) / np.float32(2 * np.pi), 1)
        tilt = np.degrees(np.arcsin(np.clip(directions[:, 2], -1, 1)))
        light = self._sky(turn, tilt)
        for share, reach, haze in ((1.0, 2.1, 0.86), (3.0, 1.2, 0.72)):
            ridge = reach * (0.62 + 0.22 * self.ridge[np.mod(turn * 2048 * share, 2048).astype(int)])
            hills = tilt < ridge
            light[hills] = HILL * np.float32(0.6 * (1 - haze)) + AIR * np.float32(haze * 0.93)
        self._town(turn, tilt, light)
        return light

    def _sky(self, turn: Floats, tilt: Floats) -> Floats:
        height = np.clip(tilt / 32, 0, 1)[:, None] ** np.float32(0.6)
        light = HORIZON + (ZENITH - HORIZON) * height
        cloud = self.clouds[np.clip(tilt * 9, 0, 255).astype(int), np.mod(turn * 4096, 1024).astype(int)]
        return light + np.clip(cloud * 0.5 - 0.2, 0, 0.5)[:, None] * (np.float32(1.25) - light) * 0.6

    def _town(self, turn: Floats, tilt: Floats, light: Floats) -> None:
        """Rows of houses, nearer ones lower and clearer."""
        for row, (level, size, haze) in enumerate(
            ((0.1, 2600, 0.82), (-1.2, 1700, 0.74), (-2.9, 1000, 0.66))
        ):
            place = turn * np.float32(size)
            house = np.mod(np.floor(place) + row * 1201, 4096).astype(int)
            top = level + 0.3 * self.houses[0, house] * (1 + row * 0.6)
            gable = (np.abs(np.mod(place, 1) - 0.5) - 0.5) * -0.22 * (1 + row * 0.6)
            inside = tilt < top + gable * (self.houses[1, house] > 0.35)
            eaves = tilt < top - 0.05
            colour = np.where(eaves[:, None], HOUSE * (0.7 + 0.5 * self.houses[1, house])[:, None], ROOF)
            light[inside] = (colour * (1 - haze) * 1.2 + AIR * haze * 0.8)[inside]
        wood = tilt < -5.2 + 0.8 * self.ridge[np.mod(turn * 16000, 2048).astype(int)]
        light[wood] = WOOD * 0.9 + AIR * 0.14
