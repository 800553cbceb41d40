"""Heads: face, ears, neck, hair and hats."""

from __future__ import annotations

import numpy as np

from gtm_hit.demo import cloth
from gtm_hit.demo.arrays import Floats
from gtm_hit.demo.loft import Part, ball, limb, loft, ring_angles
from gtm_hit.demo.pose import Pose
from gtm_hit.demo.wardrobe import Hair, Look

SECTORS = 24
# height over the middle of the head, half width, half depth, how far forward: metres from chin to crown
SKULL = np.array(
    [
        [-0.126, 0.004, 0.004, 0.048],
        [-0.124, 0.020, 0.020, 0.046],
        [-0.112, 0.036, 0.042, 0.034],
        [-0.092, 0.049, 0.061, 0.022],
        [-0.068, 0.058, 0.074, 0.012],
        [-0.040, 0.066, 0.085, 0.004],
        [-0.010, 0.071, 0.093, 0.000],
        [0.020, 0.074, 0.097, -0.003],
        [0.048, 0.073, 0.096, -0.004],
        [0.074, 0.066, 0.088, -0.004],
        [0.094, 0.053, 0.070, -0.004],
        [0.107, 0.034, 0.046, -0.004],
        [0.112, 0.016, 0.022, -0.004],
        [0.113, 0.002, 0.002, -0.004],
    ]
)
# lowest point of the hair at the front, the temples, behind the ears and at the back
HAIRLINES = {
    Hair.SHORT: (0.066, 0.010, -0.040, -0.078),
    Hair.CROPPED: (0.072, 0.022, -0.025, -0.062),
    Hair.LONG: (0.070, -0.012, -0.105, -0.115),
    Hair.PONYTAIL: (0.070, 0.004, -0.050, -0.085),
    Hair.CAP: (0.048, 0.014, -0.030, -0.072),
    Hair.BEANIE: (0.046, 0.012, -0.015, -0.050),
}
THICKNESS = {Hair.SHORT: 0.016, Hair.CROPPED: 0.005, Hair.LONG: 0.017, Hair.PONYTAIL: 0.010}


def head(look: Look, pose: Pose) -> list[Part]:
    parts = [_skull(look, pose), _neck(look, pose), *_ears(look, pose), _scalp(look, pose)]
    if look.hair is Hair.LONG:
        parts.append(_mane(look, pose))
    if look.hair is Hair.PONYTAIL:
        parts.append(_tail(look, pose))
    if look.hair is Hair.CAP:
        parts.append(_visor(look, pose))
    return parts


def _rings(pose: Pose, swell: float) -> Floats:
    left, front, up = pose.face
    height = SKULL[:, 0] * (1 + swell / 0.11)
    centres = pose.head + height[:, None] * up + SKULL[:, 3:] * front
    width, depth = np.maximum(SKULL[:, 1:3].T + swell, 0.001)
    width[[0, -1]] = depth[[0, -1]] = 0.001  # closed at the chin and at the crown
    return loft(centres, left, front, width, depth, 2.1, SECTORS)


def _skull(look: Look, pose: Pose) -> Part:
    points = _rings(pose, 0.0)
    angles, heights = np.meshgrid(ring_angles(SECTORS), SKULL[:, 0])
    nose = 0.026 * np.exp(-((angles / 0.13) ** 2)) * np.exp(-(((heights + 0.032) / 0.021) ** 2))
    brow = 0.005 * np.exp(-((angles / 0.6) ** 2)) * np.exp(-(((heights - 0.03) / 0.012) ** 2))
    return Part(points + (nose + brow)[..., None] * pose.face[1], cloth.face(look))


def _neck(look: Look, pose: Pose) -> Part:
    base, top = pose.spine[2] - 0.05 * pose.chest[2], pose.head - 0.02 * pose.face[1]
    line = np.stack((base, (base + top) / 2 - 0.008 * pose.chest[1], top))
    girth = 0.046 if look.womanly else 0.056
    stations = np.linspace(0, 2, 7)
    width = girth * np.array([1.25, 1.1, 1.0, 0.97, 0.97, 1.0, 0.9])
    return Part(
        limb(line, pose.chest[1], stations, width, width * 1.06, 0.4),
        cloth.plain(look.skin * 0.94, look.seed + 12, 0.02, 0.01),
    )


def _ears(look: Look, pose: Pose) -> list[Part]:
    if look.hair in (Hair.LONG, Hair.BEANIE):
        return []
    left, front, up = pose.face
    colours = cloth.plain(look.skin * np.float32(0.9), look.seed + 13, 0.02, 0.01)
    spots = [pose.head + side * 0.074 * left - 0.008 * front - 0.004 * up for side in (1, -1)]
    return [Part(ball(spot, left, front, up, (0.011, 0.020, 0.031), 7), colours, True) for spot in spots]


def _scalp(look: Look, pose: Pose) -> Part:
    """Hair or hat: a shell around the skull that dives under the skin where the face is free."""
    hat = look.hair in (Hair.CAP, Hair.BEANIE)
    thickness = THICKNESS.get(look.hair, 0.014)
    angles, heights = np.meshgrid(ring_angles(SECTORS), SKULL[:, 0])
    line = np.interp(np.abs(angles), (0.55, 1.05, 1.75, 2.4), HAIRLINES[look.hair])
    shown = np.clip((heights - line) / 0.02 + 0.5, 0, 1)
    outer, inner = _rings(pose, thickness), _rings(pose, -0.016)
    if look.hair is Hair.BEANIE:
        outer = outer + (np.clip(heights / 0.1, 0, 1) * 0.02)[..., None] * (pose.face[2] - 0.4 * pose.face[1])
    colours = cloth.plain(look.hat_colour, look.seed + 14) if hat else cloth.hair(look.hair_colour, look.seed)
    return Part(inner + shown[..., None] * (outer - inner), colours)


def _mane(look: Look, pose: Pose) -> Part:
    left, front, up = pose.face
    drop = np.array([0.085, 0.08, 0.05, 0.0, -0.05, -0.1, -0.15, -0.2, -0.235, -0.245])
    width = np.array([0.01, 0.05, 0.075, 0.086, 0.09, 0.092, 0.096, 0.094, 0.08, 0.02])
    depth = np.array([0.01, 0.04, 0.055, 0.062, 0.06, 0.052, 0.046, 0.042, 0.036, 0.01])
    back = np.array([0.03, 0.035, 0.045, 0.052, 0.062, 0.078, 0.092, 0.1, 0.1, 0.1])
    centres = pose.head + drop[:, None] * up - back[:, None] * front
    return Part(loft(centres, left, front, width, depth, 2.3), cloth.hair(look.hair_colour, look.seed + 1))


def _tail(look: Look, pose: Pose) -> Part:
    _, front, up = pose.face
    root = pose.head + 0.045 * up - 0.095 * front
    line = np.stack((root, root - 0.06 * front - 0.03 * up, root - 0.06 * front - 0.21 * up))
    width = np.array([0.012, 0.018, 0.026, 0.03, 0.032, 0.03, 0.026, 0.018, 0.006])
    return Part(
        limb(line, front + 0.2 * up, np.linspace(0, 2, 9), width, width, 0.5),
        cloth.hair(look.hair_colour, look.seed + 1),
    )


def _visor(look: Look, pose: Pose) -> Part:
    left, front, up = pose.face
    middle = pose.head + 0.052 * up + 0.105 * front
    flat = (up * 0.97 + front * 0.24) / np.linalg.norm(up * 0.97 + front * 0.24)
    return Part(
        ball(middle, left, np.cross(left, flat) * -1, flat, (0.072, 0.07, 0.008)),
        cloth.plain(look.hat_colour * np.float32(0.8), look.seed + 15),
    )
