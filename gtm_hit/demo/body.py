"""A dressed body: from a pose and a look to surfaces in the body frame of `pose`."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from gtm_hit.demo import cloth
from gtm_hit.demo.arrays import Floats
from gtm_hit.demo.headwear import head
from gtm_hit.demo.loft import Part, bent_line, box, limb, loft
from gtm_hit.demo.pose import ANKLE, SIDES, UP, Pose
from gtm_hit.demo.wardrobe import Bag, Bottom, Look, Top

# Half width and half depth of the trunk at stations from the crotch (0) over the chest (1) to the neck (2).
STATIONS = np.array([0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.66, 1.78, 1.88, 1.95, 2.04])
MAN = np.array(
    [
        [0.125, 0.166, 0.153, 0.156, 0.168, 0.174, 0.182, 0.176, 0.156, 0.118, 0.080, 0.058],
        [0.100, 0.116, 0.108, 0.108, 0.116, 0.120, 0.116, 0.104, 0.092, 0.080, 0.068, 0.058],
    ]
)
WOMAN = np.array(
    [
        [0.125, 0.172, 0.142, 0.134, 0.148, 0.152, 0.160, 0.154, 0.136, 0.102, 0.066, 0.048],
        [0.102, 0.120, 0.098, 0.100, 0.122, 0.124, 0.106, 0.092, 0.080, 0.068, 0.058, 0.048],
    ]
)
EASE = {Top.TSHIRT: 0.008, Top.SHIRT: 0.012, Top.JACKET: 0.024, Top.COAT: 0.028}
LEG = np.array(
    [  # station, half width of a slim and of a wide leg, half depth of both
        [-0.12, 0.045, 0.055, 0.050, 0.060],
        [-0.02, 0.082, 0.090, 0.088, 0.096],
        [0.15, 0.084, 0.094, 0.090, 0.100],
        [0.50, 0.074, 0.086, 0.080, 0.090],
        [0.85, 0.060, 0.074, 0.063, 0.078],
        [1.00, 0.057, 0.071, 0.062, 0.075],
        [1.15, 0.055, 0.070, 0.062, 0.075],
        [1.40, 0.053, 0.069, 0.060, 0.075],
        [1.75, 0.043, 0.067, 0.048, 0.074],
        [2.00, 0.040, 0.066, 0.044, 0.074],
        [2.06, 0.041, 0.066, 0.046, 0.075],
        [2.07, 0.020, 0.030, 0.020, 0.030],
    ]
)
BARE_LEG = np.array([0.05, 0.08, 0.082, 0.07, 0.055, 0.051, 0.05, 0.052, 0.038, 0.034, 0.034, 0.02])
ARM = np.array(
    [  # station, half width and half depth of a bare arm; the hand lies beyond the wrist (2)
        [-0.15, 0.004, 0.004],
        [-0.13, 0.022, 0.023],
        [-0.05, 0.045, 0.047],
        [0.15, 0.051, 0.054],
        [0.45, 0.046, 0.049],
        [0.80, 0.041, 0.043],
        [1.00, 0.041, 0.043],
        [1.25, 0.040, 0.042],
        [1.60, 0.033, 0.035],
        [1.90, 0.027, 0.028],
        [1.98, 0.025, 0.027],
        [2.04, 0.020, 0.028],
        [2.16, 0.017, 0.037],
        [2.34, 0.016, 0.040],
        [2.50, 0.014, 0.036],
        [2.60, 0.011, 0.028],
        [2.66, 0.003, 0.008],
    ]
)
WRIST = 1.97


def body(look: Look, pose: Pose, build: float) -> list[Part]:
    """All surfaces of one person of normal height."""
    parts = [*_legs(look, pose, build), _pelvis(look, pose, build), _trunk(look, pose, build)]
    parts += _arms(look, pose, build) + _shoes(look, pose) + head(look, pose)
    if look.bottom in (Bottom.SKIRT, Bottom.DRESS):
        parts.append(
            _drape(
                look,
                pose,
                build,
                0.52,
                0.52 + 0.14 * (look.seed % 3) / 2,
                cloth.plain(look.bottom_colour, look.seed + 9, 0.16),
            )
        )
    if look.top is Top.COAT:
        parts.append(_drape(look, pose, build, 0.5, 0.52, cloth.plain(look.top_colour, look.seed + 5, 0.12)))
    return parts + _bag(look, pose, build)


def _spine(pose: Pose, stations: Floats) -> tuple[Floats, Floats, Floats]:
    """Centres and the left and front of the trunk, turning from the hips' to the chest's."""
    share = np.clip((stations - 0.3) / 1.1, 0, 1)[:, None]
    left = pose.hips[0] * (1 - share) + pose.chest[0] * share
    front = pose.hips[1] * (1 - share) + pose.chest[1] * share
    return bent_line(pose.spine, stations, 0.4), left, front


def _girth(look: Look, build: float, stations: Floats, ease: float) -> tuple[Floats, Floats]:
    width, depth = WOMAN if look.womanly else MAN
    belly = np.exp(-(((stations - 0.6) / 0.42) ** 2)) * max(build - 1, 0) * 0.35
    settled = 0.45 + 0.55 * build  # shoulders and neck grow less than the rest
    scale = np.where(stations < 1.6, build, settled)
    return (
        np.interp(stations, STATIONS, width) * scale + ease,
        np.interp(stations, STATIONS, depth) * (scale + belly) + ease,
    )


def _trunk(look: Look, pose: Pose, build: float) -> Part:
    hem = {Top.TSHIRT: 0.22, Top.SHIRT: 0.26, Top.JACKET: 0.14, Top.COAT: 0.1}[look.top]
    if look.bottom in (Bottom.SKIRT, Bottom.DRESS) and look.top is not Top.COAT:
        hem = 0.46
    stations = np.concatenate(([hem + 0.01], np.linspace(hem, 1.6, 13), np.linspace(1.66, 2.04, 8), [2.045]))
    ease = EASE[look.top] * np.clip((2.1 - stations) / 0.35, 0.35, 1)
    width, depth = _girth(look, build, stations, 0.0)
    width, depth = width + ease, depth + ease
    width[0], depth[0] = 0.75 * width[0], 0.75 * depth[0]
    width[-1], depth[-1] = 0.04, 0.04
    centres, left, front = _spine(pose, stations)
    colours = cloth.upper_body(_top_of(look), look.bag is Bag.BACKPACK)
    return Part(loft(centres, left, front, width, depth, 2.3, 28), colours)


@lru_cache(maxsize=256)
def _top_of(look: Look) -> Look:
    """A dress is of one colour."""
    if look.bottom is not Bottom.DRESS:
        return look
    return replace(look, top_colour=look.bottom_colour)


def _pelvis(look: Look, pose: Pose, build: float) -> Part:
    stations = np.array([-0.06, -0.04, 0.06, 0.18, 0.3, 0.45, 0.56, 0.57])
    width, depth = _girth(look, build, np.maximum(stations, 0.0), 0.006)
    scale = np.array([0.02, 0.55, 0.92, 1, 0.97, 0.93, 0.9, 0.3])
    centres, left, front = _spine(pose, stations)
    return Part(
        loft(centres, left, front, width * scale, depth * scale, 2.2),
        cloth.plain(look.bottom_colour, look.seed + 10),
    )


def _legs(look: Look, pose: Pose, build: float) -> list[Part]:
    wide = 0.25 + 0.75 * ((look.seed % 97) / 96) * (0.6 if look.womanly else 1.0)
    width = LEG[:, 1] * (1 - wide) + LEG[:, 2] * wide
    depth = LEG[:, 3] * (1 - wide) + LEG[:, 4] * wide
    bare_from = {Bottom.TROUSERS: 1.1, Bottom.SHORTS: 0.44}.get(look.bottom, 0.0)
    if look.bottom is not Bottom.TROUSERS:
        bare = LEG[:, 0] >= bare_from * 2.19 - 0.12
        width, depth = np.where(bare, BARE_LEG, width), np.where(bare, BARE_LEG * 1.06, depth)
    colours = cloth.trousers(look, bare_from)
    girth = 0.35 + 0.65 * build
    dense = np.interp(np.linspace(0, 1, 23), np.linspace(0, 1, len(LEG)), LEG[:, 0])
    width, depth = (np.interp(dense, LEG[:, 0], size) * girth for size in (width, depth))
    return [Part(limb(joints, pose.hips[1], dense, width, depth, 0.22), colours) for joints in pose.legs]


def _arms(look: Look, pose: Pose, build: float) -> list[Part]:
    bare_from = 0.62 if look.top is Top.TSHIRT else WRIST
    girth = (0.4 + 0.6 * build) * (0.86 if look.womanly else 1.0)
    stations = np.interp(np.linspace(0, 1, 27), np.linspace(0, 1, len(ARM)), ARM[:, 0])
    sleeved = np.where(stations < bare_from, EASE[look.top] * 0.75, 0.0)
    width, depth = (np.interp(stations, ARM[:, 0], sizes) * girth + sleeved for sizes in ARM[:, 1:].T)
    # Rows of the colours follow the rings, not their distances.
    share = float(np.interp(bare_from, stations, np.linspace(0, 1, len(stations))))
    sleeve = cloth.sleeve(_top_of(look), share)
    return [Part(limb(joints, _palm(pose), stations, width, depth, 0.2), sleeve) for joints in pose.arms]


def _palm(pose: Pose) -> Floats:
    """What the flat of the hand is square to: hands hang with their edges to the front."""
    return pose.chest[1] + 0.3 * UP


def _shoes(look: Look, pose: Pose) -> list[Part]:
    lengths = np.array([-0.082, -0.078, -0.06, -0.02, 0.03, 0.07, 0.11, 0.15, 0.18, 0.196, 0.2])
    width = np.array([0.006, 0.024, 0.036, 0.037, 0.037, 0.041, 0.046, 0.045, 0.034, 0.018, 0.004])
    top = np.array([0.035, 0.075, 0.088, 0.095, 0.09, 0.074, 0.06, 0.05, 0.042, 0.034, 0.02])
    slim = 0.9 if look.womanly else 1.0
    colours, parts = cloth.shoe(look), []
    for side, pitch, joints in zip(SIDES, pose.foot_pitch, pose.legs, strict=True):
        ahead = np.array([np.cos(pitch), side * 0.14, np.sin(pitch)])
        ahead /= np.linalg.norm(ahead)
        left = np.cross(UP, ahead)
        left /= np.linalg.norm(left)
        up = np.cross(ahead, left)
        sole = np.where(lengths > 0.16, (lengths - 0.16) * 0.35, 0.0)  # toes are off the ground a little
        middle = (top + sole) / 2 - ANKLE
        centres = joints[2] + lengths[:, None] * ahead * slim + middle[:, None] * up
        parts.append(Part(loft(centres, left, up, width * slim, (top - sole) / 2, 3.0), colours))
    return parts


def _drape(look: Look, pose: Pose, build: float, top: float, length: float, colours: Floats) -> Part:
    """A skirt or the lower half of a coat: hangs from the waist around both legs."""
    stations = np.linspace(0, 1, 12) * length
    waist, left, front = _spine(pose, np.full(12, top))
    width, depth = (float(size[0]) for size in _girth(look, build, np.array([top]), EASE[look.top] + 0.006))
    hips = float(_girth(look, build, np.array([0.2]), EASE[look.top] + 0.012)[0][0])
    centres = waist - stations[:, None] * UP
    ahead, behind = _thighs_reach(pose, centres[:, 2])
    # Cloth hangs straight down from where a thigh pushes it furthest out.
    ahead = np.maximum.accumulate(np.maximum(ahead, centres[:, 0] + depth))
    behind = np.minimum.accumulate(np.minimum(behind, centres[:, 0] - depth))
    centres[:, 0] = (ahead + behind) / 2
    wide = np.interp(stations, (0, 0.16, length), (width, hips, hips * 1.1 + 0.02))
    points = loft(centres, left, front, wide, (ahead - behind) / 2, 2.4, 28)
    waves = (
        1 + 0.03 * np.cos(7 * np.linspace(0, 2 * np.pi, 29) + look.seed % 7) * (stations / length)[:, None]
    )
    return Part(centres[:, None] + (points - centres[:, None]) * waves[..., None], colours)


def _thighs_reach(pose: Pose, levels: Floats) -> tuple[Floats, Floats]:
    """How far ahead and behind the legs are at heights (R,), their flesh included."""
    lines = [bent_line(joints, np.linspace(0, 1.6, 24), 0.2) for joints in pose.legs]
    middles = np.stack([np.interp(levels, line[::-1, 2], line[::-1, 0]) for line in lines])
    flesh = np.where(levels < pose.legs[0, 0, 2] + 0.02, 0.118, 0.0)
    return middles.max(axis=0) + flesh, middles.min(axis=0) - flesh


def _bag(look: Look, pose: Pose, build: float) -> list[Part]:
    left, front, up = pose.chest
    colours = cloth.bag(look.bag_colour, look.seed + 11)
    if look.bag is Bag.BACKPACK:
        middle = pose.spine[1] - front * (0.185 * (0.5 + 0.5 * build) + EASE[look.top]) + 0.03 * up
        return [Part(box(middle, left, front, up, (0.145, 0.075, 0.215), 4.5), colours)]
    if look.bag is Bag.TOTE:
        shoulder = pose.arms[1, 0]
        middle = shoulder - left * 0.055 - 0.5 * UP - front * 0.02
        strap = np.stack((middle + 0.12 * UP, (middle + shoulder) / 2 + 0.05 * UP, shoulder + 0.045 * UP))
        line = limb(strap, front, np.linspace(0, 2, 9), np.full(9, 0.008), np.full(9, 0.02), 0.2)
        pouch = box(middle, left, front, UP, (0.045, 0.155, 0.14), 3.5)
        return [Part(pouch, colours), Part(line, colours)]
    if look.bag is Bag.SUITCASE:
        wrist = pose.arms[1, 2]
        case = np.array([-0.42, -0.2, 0.33])
        top, bend, grip = np.array([[0.03, 0, 0.28], [0.1, 0, 0.42], [0, 0, -0.06]])
        rail = np.stack((case + top, case + bend, wrist + grip))
        line = limb(rail, UP, np.linspace(0, 2, 7), np.full(7, 0.012), np.full(7, 0.05), 0.2)
        tilted = np.array([-0.28, 0.0, 0.96])
        shell = box(case, np.array([0.0, 1, 0]), np.cross([0.0, 1, 0], tilted), tilted, (0.19, 0.11, 0.29), 5)
        return [Part(shell, colours), Part(line, colours * 0.4)]
    return []
