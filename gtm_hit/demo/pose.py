"""Where the joints of one body are: a walking or standing pose.

Body frame: metres, x ahead, y to the left, z up, origin on the ground midway between the feet.
Arrays of pairs hold the left side first.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from gtm_hit.demo.arrays import Floats

NORMAL_HEIGHT = 1.75  # metres; the proportions below are those of a body this tall
SIDES = np.array([1.0, -1.0])
UP = np.array([0.0, 0.0, 1.0])
THIGH, SHANK, ANKLE = 0.425, 0.405, 0.085
UPPER_ARM, FOREARM = 0.285, 0.245
HIP_WIDTH, SHOULDER_WIDTH = 0.088, 0.172
FOOT_BACK = 0.055  # the ankle is this far behind the middle of the foot
HIP_HEIGHT = 0.91
FULL_STEP = 0.34  # metres, half the distance between the heels at 1.3 m/s


class Arms(StrEnum):
    SWING = "swing"
    POCKETS = "pockets"
    PHONE = "phone"
    CROSSED = "crossed"
    STRAP = "strap"
    TALK = "talk"


# degrees: ahead, away from the body, bend of the elbow, inward turn of the forearm
STILL_ARMS: dict[Arms, tuple[tuple[float, float, float, float], tuple[float, float, float, float]]] = {
    Arms.SWING: ((2, 8, 14, 6), (-3, 8, 18, 8)),
    Arms.POCKETS: ((-16, 15, 42, 30), (-16, 15, 42, 30)),
    Arms.PHONE: ((24, 8, 104, 26), (4, 8, 18, 6)),
    Arms.CROSSED: ((22, 10, 92, 78), (24, 10, 96, 78)),
    Arms.STRAP: ((2, 8, 16, 6), (20, 10, 132, 20)),
    Arms.TALK: ((14, 12, 72, 4), (2, 9, 20, 8)),
}


@dataclass(frozen=True)
class Pose:
    legs: Floats  # (2, 3, 3) hip, knee, ankle
    arms: Floats  # (2, 3, 3) shoulder, elbow, wrist
    foot_pitch: Floats  # (2,) radians, toes up is positive
    spine: Floats  # (3, 3) crotch, middle of the chest, base of the neck
    head: Floats  # (3,) its middle
    hips: Floats  # (3, 3) rows left, front, up
    chest: Floats  # (3, 3) rows left, front, up
    face: Floats  # (3, 3) rows left, front, up


def pose(phase: float, speed: float, arms: Arms, gaze: float, turn_out: float = 0.12) -> Pose:
    """The pose of a body of normal height; speed 0 stands, with `phase` shifting the weight."""
    stride = FULL_STEP * np.sqrt(speed / 1.3) if speed > 0 else 0.03 * np.cos(phase)
    swing = stride * np.cos(phase) * SIDES if speed > 0 else stride * SIDES
    lift, foot_pitch = _feet(phase, stride) if speed > 0 else (np.zeros(2), np.zeros(2))
    spread = 0.075 if speed > 0 else 0.105
    ankles = np.stack((swing - FOOT_BACK, spread * SIDES, ANKLE + lift), axis=1)
    # A heel that leaves the ground turns the foot about its ball, which takes the ankle up and forward.
    raised = np.maximum(-foot_pitch, 0)
    ankles[:, 2] += 0.15 * np.sin(raised)
    ankles[:, 0] += 0.10 * (1 - np.cos(raised))
    twist = 0.10 * swing[0] / FULL_STEP
    hips = _turned(-twist, 0.0)
    middle = np.array([-0.02, 0.0 if speed > 0 else 0.018 * np.sin(phase), 0.0])
    middle[2] = _hip_height(middle, hips, ankles)
    hip_joints = middle + np.outer(SIDES * HIP_WIDTH, hips[0])
    knees = np.stack([_knee(hip, ankle) for hip, ankle in zip(hip_joints, ankles, strict=True)])
    lean = 0.05 if speed > 0 else 0.01
    chest = _turned(2.2 * twist, lean)
    spine = np.stack(
        (middle - 0.10 * UP, middle + 0.36 * UP + [0.012 + lean * 0.3, 0, 0], middle + 0.575 * chest[2])
    )
    spine[2, 0] += 0.01
    shoulders = spine[2] - 0.098 * chest[2] + np.outer(SIDES * SHOULDER_WIDTH, chest[0])
    arm_joints = _arms(shoulders, chest, swing / FULL_STEP, arms, speed > 0)
    face = _turned(gaze, 0.06 if arms is not Arms.PHONE else 0.38)
    return Pose(
        legs=np.stack((hip_joints, knees, ankles), axis=1),
        arms=arm_joints,
        foot_pitch=foot_pitch,
        spine=spine,
        head=spine[2] + 0.085 * chest[2] + 0.075 * face[2] + 0.022 * face[1],
        hips=hips,
        chest=chest,
        face=face,
    )


def _feet(phase: float, stride: float) -> tuple[Floats, Floats]:
    """Lift of the swinging foot and pitch of both, for the left and the right."""
    angles = phase + np.array([0.0, np.pi])
    amount = stride / FULL_STEP
    swinging = np.maximum(-np.sin(angles), 0)
    heel_strike = np.exp(-(((angles % (2 * np.pi) - 6.1) / 0.45) ** 2)) * 0.38
    push_off = np.exp(-(((angles % (2 * np.pi) - 3.45) / 0.62) ** 2)) * -0.78
    return 0.075 * amount * swinging**1.5, amount * (heel_strike + push_off)


def _hip_height(middle: Floats, hips: Floats, ankles: Floats) -> float:
    """As high as normal, or as high as the more stretched leg allows."""
    joints = middle + np.outer(SIDES * HIP_WIDTH, hips[0])
    flat = np.hypot(*(joints - ankles)[:, :2].T)
    reach = 0.992 * (THIGH + SHANK)
    return float(min(HIP_HEIGHT, (ankles[:, 2] + np.sqrt(reach**2 - flat**2)).min()))


def _knee(hip: Floats, ankle: Floats) -> Floats:
    """The knee of a leg of two bones, bent forward."""
    line = ankle - hip
    distance = min(float(np.linalg.norm(line)), 0.999 * (THIGH + SHANK))
    along = (THIGH**2 - SHANK**2 + distance**2) / (2 * distance)
    out = np.sqrt(max(THIGH**2 - along**2, 0.0))
    direction = line / np.linalg.norm(line)
    forward = np.array([1.0, 0.0, 0.0]) - direction * direction[0]
    return hip + direction * along + forward / np.linalg.norm(forward) * out


def _arms(shoulders: Floats, chest: Floats, swing: Floats, arms: Arms, walks: bool) -> Floats:
    joints = []
    for side, shoulder, opposite, angles in zip(SIDES, shoulders, -swing, STILL_ARMS[arms], strict=True):
        ahead, away, bend, inward = np.radians(angles)
        free = arms is Arms.SWING or bend < np.radians(30)
        if walks and free:
            ahead += 0.46 * opposite
            bend += 0.22 + 0.22 * opposite
        upper = np.array([np.sin(ahead) * np.cos(away), side * np.sin(away), -np.cos(ahead) * np.cos(away)])
        lower = np.array(
            [
                np.sin(ahead + bend) * np.cos(inward),
                side * (0.6 * np.sin(away) - np.sin(inward)),
                -np.cos(ahead + bend) * np.cos(inward * 0.5),
            ]
        )
        body = np.stack((chest[1], chest[0], chest[2]))  # rows ahead, left, up
        elbow = shoulder + UPPER_ARM * (upper @ body)
        wrist = elbow + FOREARM * (lower / np.linalg.norm(lower) @ body)
        joints.append((shoulder, elbow, wrist))
    return np.array(joints)


def _turned(left: float, down: float) -> Floats:
    """Rows left, front, up of a frame turned to the left and then bowed."""
    front = np.array([np.cos(left) * np.cos(down), np.sin(left) * np.cos(down), -np.sin(down)])
    side = np.array([-np.sin(left), np.cos(left), 0.0])
    return np.stack((side, front, np.cross(front, side)))
