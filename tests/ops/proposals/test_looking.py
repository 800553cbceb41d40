"""Stored pictures in, proposals out: the rooms that look, behind the operation."""

from __future__ import annotations

import pytest

from gtm_hit.models import Dataset, PictureBoxes
from gtm_hit.ops.proposals import detectors, job, looking
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.job import Order
from gtm_hit.vision.boxes import Box, Picture
from gtm_hit.vision.detectors import DetectorError


class Everywhere:
    """Sees somebody in the middle of every picture."""

    version = "everywhere-1"

    def __init__(self) -> None:
        self.looks = 0

    def detect(self, image: Picture) -> list[Box]:
        self.looks += 1
        height, width = image.shape[:2]
        return [Box(0.45 * width, 0.3 * height, 0.55 * width, 0.7 * height, 0.9)]


class Broken(Everywhere):
    def detect(self, image: Picture) -> list[Box]:
        raise DetectorError("the detector answers nonsense")


@pytest.fixture
def everywhere(monkeypatch: pytest.MonkeyPatch) -> Everywhere:
    made = Everywhere()
    monkeypatch.setattr(detectors, "find", lambda *_asked: made)
    return made


def test_a_detector_sees_every_picture_once_whatever_the_method(
    dataset: Dataset, everywhere: Everywhere
) -> None:
    for method in ("cover", "projected", "cover"):
        run, proposed = job.do(dataset, Order(method))
        assert (run.method, run.model) == (method, "everywhere-1")
    assert proposed.known == 8
    assert everywhere.looks == 16
    assert PictureBoxes.objects.count() == 16


def test_boxes_are_kept_in_pixels_of_the_calibrated_picture(dataset: Dataset, everywhere: Everywhere) -> None:
    job.do(dataset, Order("projected"))
    (left, *_rest) = PictureBoxes.objects.all()[0].boxes[0]
    assert left == pytest.approx(0.45 * 1920)


def test_without_the_built_in_detector_the_background_does_and_says_so(dataset: Dataset) -> None:
    run, _proposed = job.do(dataset, Order())
    assert (run.method, run.model) == ("background", "")
    assert run.parameters["asked"] == "cover"


@pytest.mark.parametrize(
    "detector", [detectors.BUILT_IN, detectors.NONE, "http://elsewhere", "file:/nowhere.py"]
)
def test_a_method_whose_detector_cannot_be_had_says_so(dataset: Dataset, detector: str) -> None:
    with pytest.raises(ProposalError):
        looking.looker(dataset, "projected", detector)


def test_a_broken_detector_fails_the_job_with_its_words(
    dataset: Dataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(detectors, "find", lambda *_asked: Broken())
    with pytest.raises(ProposalError, match="nonsense"):
        job.do(dataset, Order())
    assert not PictureBoxes.objects.exists()
