"""Boxes of a detector, kept by picture and model: the slow part is never done twice."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from gtm_hit.models import PictureBoxes
from gtm_hit.ops.proposals.pictures import StoredPictures
from gtm_hit.vision.boxes import Box, Picture

Detect = Callable[[Mapping[str, Picture]], Mapping[str, list[Box]]]
"""Boxes by camera, of pictures by camera."""


def boxes_of(pictures: StoredPictures, model: str, detect: Detect) -> dict[str, list[Box]]:
    """By camera; only pictures that this model has not seen are looked at."""
    known = known_boxes(pictures, model)
    missing = {name: pictures[name] for name in pictures if name not in known}
    found = {name: [Box(*box) for box in boxes] for name, boxes in detect(missing).items()} if missing else {}
    PictureBoxes.objects.bulk_create(
        [
            PictureBoxes(
                picture=pictures.digests[name],
                model=model,
                boxes=[[float(side) for side in box] for box in boxes],
            )
            for name, boxes in found.items()
        ],
        ignore_conflicts=True,  # another worker saw the same picture at the same moment
    )
    return {**known, **found}


def known_boxes(pictures: StoredPictures, model: str) -> dict[str, list[Box]]:
    kept = PictureBoxes.objects.filter(picture__in=pictures.digests.values(), model=model)
    by_digest = {each.picture: [Box(*box) for box in each.boxes] for each in kept}
    return {name: by_digest[each] for name, each in pictures.digests.items() if each in by_digest}
