"""What looking at a frame finds: proposed people with the evidence for each, and cameras that disagree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

Sides = tuple[float, float, float, float]  # x1, y1, x2, y2: pixels of the calibrated picture


@dataclass(frozen=True, slots=True)
class Evidence:
    """What one camera says about a proposed person; cameras that cannot see the place say nothing."""

    camera: str
    box: Sides | None  # the detector's box that was counted for this person
    seen: float  # share of the person's rectangle that is not background, 0…1; NaN where that is unknown
    hidden: bool  # somebody nearer covers most of the rectangle


@dataclass(frozen=True, slots=True)
class Proposal:
    x: float  # metres on the ground
    y: float
    height: float  # metres
    radius: float
    score: float  # 0…1: how likely a person stands here
    evidence: tuple[Evidence, ...]
    method: str  # of `proposing.Method`
    seated: bool = False

    @property
    def views(self) -> int:
        """In how many views the detector boxed them."""
        return sum(each.box is not None for each in self.evidence)


@dataclass(frozen=True, slots=True)
class CameraAlarm:
    """A camera whose picture contradicts all the others: its pose or its clock is probably off."""

    camera: str
    metres: float  # by how much its people stand elsewhere, median; NaN where that could not be told
    why: str  # a sentence for managers


@dataclass(frozen=True)
class FrameProposals:
    people: tuple[Proposal, ...]
    suspicious: tuple[CameraAlarm, ...] = ()


def as_json(proposal: Proposal) -> dict[str, Any]:
    """Plain values; NaN becomes None, which JSON knows."""
    return {
        "x": proposal.x,
        "y": proposal.y,
        "height": proposal.height,
        "radius": proposal.radius,
        "score": proposal.score,
        "method": proposal.method,
        "seated": proposal.seated,
        "evidence": [
            {
                "camera": each.camera,
                "box": None if each.box is None else list(each.box),
                "seen": each.seen if each.seen == each.seen else None,
                "hidden": each.hidden,
            }
            for each in proposal.evidence
        ],
    }
