"""The bridge from stored pictures to the room that looks for people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from gtm_hit.models import Dataset
from gtm_hit.ops.proposals import detectors
from gtm_hit.ops.proposals.boxes import boxes_of
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.pictures import StoredPictures
from gtm_hit.vision.background import Backgrounds
from gtm_hit.vision.boxes import Box, Detector, Picture
from gtm_hit.vision.detectors import DetectorError, Params
from gtm_hit.vision.located import Locator
from gtm_hit.vision.masks import Masks, Notes
from gtm_hit.vision.people import FrameProposals
from gtm_hit.vision.proposing import Method, Proposer, Scene, Settings, usable_method

NEEDS_BACKGROUND = {Method.COVER, Method.BACKGROUND, Method.POM, Method.LOCATED}
NEEDS_DETECTOR = {Method.COVER, Method.PROJECTED}


class SceneLooker:
    """Looks at the frames of one dataset; `method`, `model` and `settings` tell runs apart."""

    def __init__(
        self, dataset: Dataset, method: Method, detector: Detector | Locator | None, settings: Settings
    ) -> None:
        cameras = {camera.name: camera for camera in dataset.calibrated_cameras()}
        self._scene = Scene(cameras, dataset.grid, dataset.cylinder, dataset.rule)
        self._method = method
        self._proposer = Proposer(self._scene, method, detector, settings)
        self._notes = Notes(self._proposer.backgrounds)
        self.method = method.value
        self.model = detector.version if detector else ""
        self.settings: dict[str, Any] = asdict(settings)

    def prepare(self, group: Sequence[StoredPictures]) -> None:
        if self._method in NEEDS_BACKGROUND:
            self._notes = Notes(Backgrounds.learn(group, self._scene.cameras))
            self._proposer.backgrounds = self._notes.backgrounds

    def look(self, pictures: StoredPictures) -> FrameProposals:
        """Raises ProposalError where the detector does not answer as it should."""
        try:
            boxes = boxes_of(pictures, self.model, self._detect) if self._proposer.detector else {}
            return self._proposer.frame(pictures, boxes, pictures.number)
        except DetectorError as error:
            raise ProposalError(f"Frame {pictures.number}: {error}") from error

    def foregrounds(self) -> Masks:
        return self._notes.take()

    def _detect(self, pictures: Mapping[str, Picture]) -> Mapping[str, list[Box]]:
        return self._proposer.boxes(pictures)


def looker(dataset: Dataset, method: str, detector: str, params: Params | None = None) -> SceneLooker:
    """Raises ProposalError where the detector cannot be had.

    Where the built-in one was never fetched, the background alone has to do.
    """
    wanted = Method(method)
    try:
        found = detectors.find(detector, params) if wanted in NEEDS_DETECTOR else None
    except DetectorError as error:
        raise ProposalError(str(error)) from error
    usable = usable_method(wanted, found)
    if usable is Method.PROJECTED and isinstance(found, Locator):
        raise ProposalError(f"{method} needs boxes, and {detector} says places")
    if usable in NEEDS_DETECTOR and found is None:
        raise ProposalError(f"{method} needs a detector; `make detector` fetches the built-in one")
    return SceneLooker(dataset, usable, found, Settings())
