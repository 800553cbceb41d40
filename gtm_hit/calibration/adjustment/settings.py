"""How an adjustment is done."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Variant(StrEnum):
    """What of the lenses may move. The first three are those of WILDTRACK's authors."""

    FIXED = "fixed"  # lenses stay, poses and points move
    BOTH = "both"  # everything moves at once
    TWO_PASS = "two-pass"  # first as `fixed`, then as `both`
    SOFT = "soft"  # as `two-pass`, but lenses are held near those of the lens step


@dataclass(frozen=True)
class Settings:
    turn: float = 1.0  # pixels: beyond it a miss counts in proportion to its length (Huber)
    ground_weight: float | None = None  # of a measured point's observation; None: free ones / measured ones
    focal_share: float = 0.01  # σ of a focal length, as a share of it, where the lens step gave none
    centre_sigma: float = 15.0  # pixels
    radial_sigmas: tuple[float, float, float] = (0.03, 0.1, 0.15)  # of k1, k2, k3; k4 to k6 alike
    tangential_sigma: float = 0.002
    tolerance: float = 1e-7  # a step that lowers the cost by a smaller share is the last
    rough_tolerance: float = 1e-5  # the same, for the first of two passes
    most_steps: int = 300  # of one pass

    def lens_sigmas(self, fx: float, fy: float) -> dict[str, float]:
        """How far each number of a lens may be off, by name."""
        k1, k2, k3 = self.radial_sigmas
        return {
            "fx": self.focal_share * fx,
            "fy": self.focal_share * fy,
            "cx": self.centre_sigma,
            "cy": self.centre_sigma,
            "k1": k1,
            "k2": k2,
            "p1": self.tangential_sigma,
            "p2": self.tangential_sigma,
            "k3": k3,
            "k4": k1,
            "k5": k2,
            "k6": k3,
        }
