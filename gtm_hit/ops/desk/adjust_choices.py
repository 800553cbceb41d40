"""How the cameras of a desk are adjusted."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from gtm_hit.calibration.adjustment.problem import PARAMETERS
from gtm_hit.calibration.adjustment.settings import Settings, Variant
from gtm_hit.models import Desk
from gtm_hit.ops.desk.errors import DeskError

WHOLE = ("pose", "lens")
VARIANTS = [
    (Variant.SOFT.value, "soft: lenses are held near those of the lens step"),
    (Variant.TWO_PASS.value, "two passes: first lenses stay, then everything moves"),
    (Variant.BOTH.value, "both: everything moves at once"),
    (Variant.FIXED.value, "fixed: lenses stay, poses and points move"),
]


@dataclass(frozen=True)
class Choices:
    variant: str = Variant.SOFT.value
    turn: float = Settings.turn  # pixels beyond which a miss counts in proportion to its length (Huber)
    ground_weight: float | None = None  # of a measured point's click; None: as all other clicks together
    ground_sigma: float = 0.0  # metres measured points may be off; 0 keeps them where they are
    hold: tuple[str, ...] = ()  # CAMERA:WHAT, WHAT being pose, lens or parameters with commas between them

    def __post_init__(self) -> None:
        """Raises DeskError."""
        if self.variant not in {variant.value for variant in Variant}:
            raise DeskError(f"There is no variant {self.variant}; choose one of {', '.join(Variant)}.")
        if not (math.isfinite(self.turn) and self.turn > 0):
            raise DeskError("The miss from which a click counts less is a number of pixels above 0.")
        weight = self.ground_weight
        if weight is not None and not (math.isfinite(weight) and weight > 0):
            raise DeskError("The weight of measured points is a number above 0.")
        if not (math.isfinite(self.ground_sigma) and 0 <= self.ground_sigma <= 10):
            raise DeskError("How far measured points may be off is 0 to 10 metres.")

    @property
    def settings(self) -> Settings:
        return Settings(turn=self.turn, ground_weight=self.ground_weight)

    def stays(self, desk: Desk) -> dict[str, frozenset[str]]:
        """What does not move, by camera. Raises DeskError for names that there are not."""
        names = list(desk.cameras.values_list("name", flat=True))
        found: dict[str, set[str]] = {}
        for text in self.hold:
            camera, _, what = text.rpartition(":")
            if camera not in names:
                there = ", ".join(names)
                raise DeskError(f"{text}: write CAMERA:WHAT with one of the cameras {there}.")
            wanted = {word.strip() for word in what.split(",")}
            if unknown := sorted(wanted - {*PARAMETERS, *WHOLE}):
                there = ", ".join([*WHOLE, *PARAMETERS])
                raise DeskError(
                    f"{camera}: there is no parameter {unknown[0] or 'without a name'}; there are {there}."
                )
            found.setdefault(camera, set()).update(wanted)
        return {camera: frozenset(what) for camera, what in found.items()}

    def as_json(self) -> dict[str, Any]:
        return {**asdict(self), "hold": list(self.hold)}

    @classmethod
    def of_json(cls, values: dict[str, Any]) -> Choices:
        return cls(**{**values, "hold": tuple(values["hold"])})


def holding(texts: Iterable[str]) -> tuple[str, ...]:
    """Sorted, each once: the same choice is the same job."""
    return tuple(sorted({text.strip() for text in texts if text.strip()}))
