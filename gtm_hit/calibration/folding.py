"""Whether a lens folds inside its picture: whether two points of the world could share a pixel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.geometry import lens


@dataclass(frozen=True)
class Folding:
    """Radii in the plane of the picture, in focal lengths."""

    reach: float  # the largest radius that anything lands on; infinite where the lens never folds
    corner: float  # the farthest corner of the picture

    @property
    def monotone(self) -> bool:
        """Every pixel shows one direction only."""
        return self.reach > self.corner


def folding(of: Lens) -> Folding:
    limit = lens.limit(of.distortion)
    reach = limit
    if np.isfinite(limit):
        k1, k2, _, _, k3, k4, k5, k6 = lens.padded(of.distortion)[:8].tolist()
        r2 = limit * limit
        radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
        reach = limit * radial
    (fx, _, cx), (_, fy, cy), _ = of.matrix.tolist()
    across = max(abs(cx), abs(of.width - 1 - cx)) / fx
    down = max(abs(cy), abs(of.height - 1 - cy)) / fy
    return Folding(reach, float(np.hypot(across, down)))
