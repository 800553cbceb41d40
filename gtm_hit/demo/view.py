"""One camera's picture of the place, ready to have people put into it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from gtm_hit.demo.arrays import Bytes, Floats
from gtm_hit.demo.backdrop import Backdrop
from gtm_hit.demo.light import develop
from gtm_hit.demo.people import SHADOW_CELL, Cast, Moment, shadow_area
from gtm_hit.demo.scene import Mood, Scene
from gtm_hit.demo.splat import Sprite, draw
from gtm_hit.geometry.camera import Camera

VIGNETTE = 0.17  # how much darker the corners are
SOFTNESS = 0.5  # pixels, of the lens
NOISE = 1.35  # grey values
NOISE_MARGIN = 61  # pixels by which the noise is moved from frame to frame
CONTACT = 0.42  # how dark the ground becomes right under a shoe


@dataclass(frozen=True)
class View:
    sunny: Bytes  # (H, W, 3)
    shaded: Bytes  # (H, W, 3) where people keep the sun away
    places: NDArray[np.int16]  # (H, W, 2) and
    fractions: NDArray[np.uint16]  # (H, W), where in the map of people's shadows each pixel looks
    noise: NDArray[np.int8]  # (H + margin, W + margin, 3)

    @classmethod
    def of(cls, scene: Scene, camera: Camera, backdrop: Backdrop) -> View:
        mood = mood_of(scene, camera)
        area = shadow_area(scene)
        cells = (backdrop.beams - np.array((area.west, area.south), np.float32)) / np.float32(SHADOW_CELL)
        cells = np.clip(np.nan_to_num(cells, nan=-100.0), -100, 30000) - np.float32(0.5)
        places, fractions = cv2.convertMaps(cells[..., 0], cells[..., 1], cv2.CV_16SC2)
        sunny, shaded = (_developed(light, mood) for light in (backdrop.sunny, backdrop.shaded))
        return cls(sunny, shaded, places, fractions, _noise(scene, camera))

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        for field in fields(self):
            np.save(folder / f"{field.name}.npy", getattr(self, field.name))

    @classmethod
    def load(cls, folder: Path) -> View:
        return cls(*(np.load(folder / f"{field.name}.npy", mmap_mode="r") for field in fields(cls)))


def photograph(scene: Scene, camera: Camera, view: View, cast: Cast, now: Moment, frame: int) -> Bytes:
    """The picture (H, W, 3), RGB, of the frame with this index."""
    picture = _with_shadows(view, now)
    mood, bright = mood_of(scene, camera), _vignette(camera.height, camera.width)
    for sprite in far_to_near(camera, cast, now, frame).values():
        _put(picture, sprite, mood, bright)
    dx, dy = scene.rng(30, camera.index, frame).integers(0, NOISE_MARGIN, 2)
    noise = np.ascontiguousarray(view.noise[dy : dy + camera.height, dx : dx + camera.width])
    return np.asarray(cv2.add(picture, noise, dtype=cv2.CV_8U), np.uint8)


def mood_of(scene: Scene, camera: Camera) -> Mood:
    return scene.moods[camera.index % len(scene.moods)]


def far_to_near(camera: Camera, cast: Cast, now: Moment, frame: int) -> dict[int, Sprite]:
    """People do not overlap on the ground, so whoever stands nearer hides whoever stands farther away."""
    away = np.linalg.norm(cast.walks.xy[frame] - camera.centre[:2], axis=1)
    found = {}
    for person in np.argsort(-away, kind="stable"):
        sprite = draw(camera, now.meshes[person])
        if sprite is not None:
            found[int(person)] = sprite
    return found


def _with_shadows(view: View, now: Moment) -> Bytes:
    picture = np.array(view.sunny)
    hidden = cv2.remap(
        now.shadow,
        np.asarray(view.places),
        np.asarray(view.fractions),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_CONSTANT,
        borderValue=0,
    )
    touched = np.nonzero(np.asarray(hidden).view(np.uint16)[..., 0])  # either of the two bytes
    sun, sky = (hidden[touched].astype(np.float32) / 255).T
    lit, dark = picture[touched].astype(np.float32), view.shaded[touched].astype(np.float32)
    mixed = (lit + (dark - lit) * sun[:, None]) * (1 - np.float32(CONTACT) * sky[:, None])
    picture[touched] = mixed.astype(np.uint8)
    return picture


def _put(picture: Bytes, sprite: Sprite, mood: Mood, bright: Floats) -> None:
    height, width = sprite.cover.shape
    window = (slice(sprite.top, sprite.top + height), slice(sprite.left, sprite.left + width))
    cover = sprite.cover[..., None]
    colour = develop(sprite.colour / np.maximum(cover, 1e-3), mood) * bright[window][..., None]
    behind = picture[window].astype(np.float32)
    picture[window] = np.clip(behind + (colour - behind) * cover + 0.5, 0, 255).astype(np.uint8)


def _developed(light: Floats, mood: Mood) -> Bytes:
    shown = develop(light.copy(), mood)
    shown *= _vignette(*light.shape[:2])[..., None]
    soft = cv2.GaussianBlur(shown, (0, 0), SOFTNESS)
    return np.clip(np.asarray(soft, np.float32) + np.float32(0.5), 0, 255).astype(np.uint8)


def _vignette(rows: int, columns: int) -> Floats:
    x = (np.arange(columns, dtype=np.float32) / columns - 0.5) * 2
    y = (np.arange(rows, dtype=np.float32) / rows - 0.5) * 2
    return 1 - np.float32(VIGNETTE / 2) * (np.square(x)[None] + np.square(y)[:, None])


def _noise(scene: Scene, camera: Camera) -> NDArray[np.int8]:
    rng = scene.rng(31, camera.index)
    shape = (camera.height + NOISE_MARGIN, camera.width + NOISE_MARGIN)
    grey = rng.standard_normal(shape, dtype=np.float32)[..., None]
    colour = rng.standard_normal((*shape, 3), dtype=np.float32)
    noise = cv2.GaussianBlur(0.8 * grey + 0.6 * colour, (0, 0), 0.6)
    return np.round(noise * np.float32(NOISE / noise.std())).astype(np.int8)
