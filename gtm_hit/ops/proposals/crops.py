"""A place as the cameras show it: which pictures to cut, and where."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gtm_hit.geometry.cylinder import rectangles
from gtm_hit.models import Dataset, Image
from gtm_hit.ops.proposals.missing import Missing

MOST = 3  # views of one place
AROUND = 0.6  # of the rectangle's height, shown on each side


@dataclass(frozen=True)
class Crop:
    """Pixels of the whole picture; `digest` names it at full size."""

    camera: str
    digest: str
    width: int
    height: int
    left: float
    top: float
    box_width: float
    box_height: float

    @property
    def view(self) -> str:
        """What an SVG shows of the picture: a square around the rectangle."""
        side = max(self.box_width, self.box_height) * (1 + 2 * AROUND)
        left = self.left + self.box_width / 2 - side / 2
        top = self.top + self.box_height / 2 - side / 2
        return f"{left:.0f} {top:.0f} {side:.0f} {side:.0f}"


def crops(dataset: Dataset, places: Sequence[Missing]) -> list[list[Crop]]:
    """Of each place the views that show it largest."""
    pictures = _pictures(dataset, {place.frame for place in places})
    positions = [place.position for place in places]
    found: list[list[Crop]] = [[] for _place in places]
    for camera in dataset.calibrated_cameras() if places else []:
        boxes, visible = rectangles(camera, dataset.grid, dataset.cylinder, dataset.rule, positions)
        for place, mine, box, seen in zip(places, found, boxes.tolist(), visible.tolist(), strict=True):
            digest = pictures.get((place.frame, camera.index))
            if seen and digest:
                left, top, right, bottom = box
                size = (camera.width, camera.height)
                mine.append(Crop(camera.name, digest, *size, left, top, right - left, bottom - top))
    return [sorted(mine, key=lambda crop: -crop.box_height)[:MOST] for mine in found]


def _pictures(dataset: Dataset, numbers: set[int]) -> dict[tuple[int, int], str]:
    rows = Image.objects.filter(frame__dataset=dataset, frame__number__in=numbers)
    return {
        (number, camera): digest
        for number, camera, digest in rows.values_list("frame__number", "camera__index", "full_digest")
    }
