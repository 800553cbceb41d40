"""Detectors see a picture once."""

from __future__ import annotations

from collections.abc import Mapping

from gtm_hit.models import Dataset, PictureBoxes
from gtm_hit.ops.proposals.boxes import boxes_of
from gtm_hit.ops.proposals.pictures import pictures_of
from gtm_hit.vision.boxes import Box, Picture


def test_a_picture_is_looked_at_once_by_each_model(dataset: Dataset) -> None:
    seen: list[list[str]] = []

    def detect(pictures: Mapping[str, Picture]) -> dict[str, list[Box]]:
        seen.append(sorted(pictures))
        return {name: [Box(1, 2, picture.shape[1], 4, 0.5)] for name, picture in pictures.items()}

    pictures = pictures_of(dataset.frames.all()[:1]).popitem()[1]
    first = boxes_of(pictures, "one", detect)
    assert first["C1"] == [Box(1, 2, 96, 4, 0.5)]
    assert boxes_of(pictures, "one", detect) == first
    assert seen == [["C1", "C2"]]
    PictureBoxes.objects.filter(picture=pictures.digests["C2"]).delete()
    boxes_of(pictures, "one", detect)
    boxes_of(pictures, "two", detect)
    assert seen == [["C1", "C2"], ["C2"], ["C1", "C2"]]
