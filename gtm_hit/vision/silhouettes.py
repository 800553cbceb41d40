"""Where a body is in the foreground of a view: the template laid over it, everybody else explained.

A view's answer is how far beside the expected place the template fits best, and how sure that is. It is one
only where the body explains foreground that nobody else does; feet are left out, for shadows start there.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Floats
from gtm_hit.vision.templates import PITCH, ROWS, Template, drawn, painted, sampled

Mask = NDArray[np.float32]

SHIFTS = 8  # columns to either side that a template is moved


@dataclass(frozen=True)
class SilhouetteSettings:
    template: Template = field(default_factory=drawn)
    bottom: float = 0.8  # share of the height, from the head, that is looked at
    least: float = 0.06  # gain for each cell of the template from which a view has a say
    sharp: float = 6.0  # gain by which a shift is e times as likely: neighbouring cells say the same
    smallest: float = 12.0  # pixels of the reduced picture a body must be tall
    share: float = 0.9  # of the body that must be in the picture


@dataclass(frozen=True, eq=False)
class Silhouettes:
    """What a view's foreground says about bodies."""

    middle: Floats  # (N,) pixels of the calibrated picture; NaN where it cannot be told
    spread: Floats  # (N,) of the middle, as a share of the body's height
    gain: Floats  # (N,) by which a cell of the template is likelier with the body than without; NaN: unknown


def silhouettes(
    foreground: Mask, scale: float, whole: Floats, share: Floats, s: SilhouetteSettings
) -> Silhouettes:
    """whole : (N, 4) the boxes expected, pixels of the calibrated picture, everybody's
    share : (N,) of each in the picture
    """
    boxes = whole * scale
    middle, spread, gain = (np.full(len(boxes), np.nan) for _ in range(3))
    rows = np.flatnonzero((share >= s.share) & (boxes[:, 3] - boxes[:, 1] >= s.smallest))
    if len(rows):
        gains = _gains(foreground, boxes, rows, s)
        shifts = PITCH * (np.arange(2 * SHIFTS + 1) - SHIFTS)
        weight = np.exp((gains - gains.max(axis=1, keepdims=True)) / s.sharp)
        weight /= weight.sum(axis=1, keepdims=True)
        off = weight @ shifts
        spread[rows] = np.sqrt(np.maximum(weight @ shifts**2 - off**2, 0.0))
        gain[rows] = gains.max(axis=1) / (_looked_at(s) * s.template.body.shape[1])
        told = gain[rows] >= s.least
        tall, centre = whole[rows, 3] - whole[rows, 1], (whole[rows, 0] + whole[rows, 2]) / 2
        middle[rows] = np.where(told, centre + off * tall, np.nan)
    return Silhouettes(middle, spread, gain)


def _looked_at(s: SilhouetteSettings) -> int:
    return round(s.bottom * ROWS)


def _gains(foreground: Mask, boxes: Floats, rows: NDArray[np.int64], s: SilhouetteSettings) -> Floats:
    """How much likelier the foreground is with each body, moved aside by each shift, than without it."""
    looked, body, nobody = _looked_at(s), s.template.body, s.template.nobody
    free = sampled(painted(s.template, boxes, foreground.shape), boxes[rows], SHIFTS)
    free[:, :, SHIFTS:-SHIFTS] -= np.log1p(-body)  # of all others
    others = 1 - (1 - nobody) * np.exp(np.minimum(free, 0.0))[:, :looked]
    seen = 2 * sampled(foreground, boxes[rows], SHIFTS)[:, :looked] - 1
    there, away = np.maximum(seen, 0), np.maximum(-seen, 0)
    body = body[:looked]
    gains = []
    for start in range(2 * SHIFTS + 1):
        at = np.s_[:, :, start : start + body.shape[1]]
        more = np.log(1 - (1 - body) * (1 - others[at])) - np.log(others[at])
        gains.append((there[at] * more + away[at] * np.log1p(-body)).sum(axis=(1, 2)))
    result: Floats = np.stack(gains, axis=1)
    return result
