"""Pictures of a frame become proposals: the one door to all methods.

A `Proposer` is made once for a dataset and a batch; frames are then asked for in any order, each on its own,
so that a job can stop and go on. What is slow, the detector's boxes, can be kept and handed in again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from gtm_hit.geometry.camera import Camera, Floats
from gtm_hit.geometry.cylinder import Cylinder, FootRule, rectangles
from gtm_hit.geometry.grid import Grid
from gtm_hit.vision.background import Backgrounds, Pictures
from gtm_hit.vision.boxes import Box, Detector, Picture
from gtm_hit.vision.cover import Body, CoverSettings, Places, cover
from gtm_hit.vision.detectors.errors import DetectorError
from gtm_hit.vision.disagreement import agreements, alarm, suspect
from gtm_hit.vision.evidence import Foregrounds, evidence_for
from gtm_hit.vision.located import Locator
from gtm_hit.vision.people import CameraAlarm, FrameProposals, Proposal
from gtm_hit.vision.placing import PlacingSettings, placed, steps_of
from gtm_hit.vision.pom import Frames, PomSettings, occupancy, peaks
from gtm_hit.vision.projected import ProjectedSettings, projected

Boxes = Mapping[str, Sequence[Box]]

STANDARD = Cylinder(0.16, 1.8)  # the published one
EVEN = 0.6  # a body's worth at which it is as likely nobody,
SLOPE = 0.35  # and by how much more it is e times as likely somebody


class Method(StrEnum):
    COVER = "cover"  # detector's boxes, placed to the centimetre by the background where that is trusted
    BACKGROUND = "background"  # no detector: peaks of the occupancy map, placed by the background
    POM = "pom"  # the occupancy map as published
    PROJECTED = "projected"  # feet of the detector's boxes, clustered
    LOCATED = "located"  # places are a model's own that looks at all views at once


@dataclass(frozen=True)
class Settings:
    least: float = 0.5  # scores below are not proposed
    refine: bool = True  # by the background, where there is one
    cover: CoverSettings = field(default_factory=CoverSettings)
    placing: PlacingSettings = field(default_factory=PlacingSettings)
    pom: PomSettings = field(default_factory=PomSettings)
    projected: ProjectedSettings = field(default_factory=ProjectedSettings)


@dataclass(frozen=True)
class Scene:
    cameras: Mapping[str, Camera]
    grid: Grid
    cylinder: Cylinder = STANDARD
    rule: FootRule = FootRule.CORNERS


class Proposer:
    def __init__(
        self,
        scene: Scene,
        method: Method,
        detector: Detector | Locator | None,
        settings: Settings,
        backgrounds: Backgrounds | None = None,
    ) -> None:
        self.scene, self.settings = scene, settings
        self.locator = detector if isinstance(detector, Locator) else None
        self.detector = None if isinstance(detector, Locator) else detector
        self.method = usable_method(method, detector)
        self.backgrounds = backgrounds or Backgrounds({})
        if self.method is Method.COVER:
            self._places = Places(scene.cameras, scene.grid, settings.cover)
        elif self.method in (Method.BACKGROUND, Method.POM):
            self._positions, self._frames = _occupancy_grid(scene, settings.pom)

    def boxes(self, pictures: Pictures) -> dict[str, list[Box]]:
        """The detector's boxes, in pixels of the calibrated pictures; may be kept per picture and version."""
        if self.detector is None:
            return {}
        return {name: self._detected(self.detector, name, picture) for name, picture in pictures.items()}

    def _detected(self, detector: Detector, name: str, picture: Picture) -> list[Box]:
        try:
            return _scaled(detector.detect(picture), self.scene.cameras[name].width / picture.shape[1])
        except DetectorError as error:
            raise DetectorError(f"{name}: {error}") from error

    def frame(self, pictures: Pictures, boxes: Boxes | None = None, number: int = 0) -> FrameProposals:
        """Of one frame; `boxes` are those of `boxes(pictures)`, found now unless given."""
        looks = self.method in (Method.COVER, Method.PROJECTED)
        boxes = (self.boxes(pictures) if boxes is None else boxes) if looks else {}
        masks = {} if self.method is Method.PROJECTED else self._foregrounds(pictures)
        suspicious: tuple[CameraAlarm, ...] = ()
        if self.locator is not None and self.method is Method.LOCATED:
            bodies = self._located(self.locator, pictures, number)
        else:
            bodies, suspicious = self._bodies(boxes, masks)
        inside = [body for body in bodies if self.scene.grid.position(body.xy[None])[0] >= 0]
        people = self._proposals(inside, boxes, masks, bodies)
        return FrameProposals(tuple(each for each in people if each.score >= self.settings.least), suspicious)

    def _foregrounds(self, pictures: Pictures) -> Foregrounds:
        known = self.backgrounds.cameras
        return {name: known[name].foreground(each) for name, each in pictures.items() if name in known}

    def _bodies(self, boxes: Boxes, masks: Foregrounds) -> tuple[list[Body], tuple[CameraAlarm, ...]]:
        if self.method is Method.PROJECTED:
            return self._projected(boxes), ()
        if self.method is Method.COVER:
            bodies, suspicious = self._covered(boxes)
            wrong = {each.camera for each in suspicious}
            masks = {name: mask for name, mask in masks.items() if name not in wrong}
        else:
            bodies, suspicious = self._occupied(masks), ()
        if self.method is not Method.POM and self.settings.refine and masks:
            bodies = placed(bodies, masks, self.scene.cameras, self.settings.placing)
        return bodies, suspicious

    def _covered(self, boxes: Boxes) -> tuple[list[Body], tuple[CameraAlarm, ...]]:
        """Bodies found without the cameras that contradict all others, and those cameras."""
        cameras, settings = self.scene.cameras, self.settings.cover
        alarms: list[CameraAlarm] = []
        left = dict(boxes)
        bodies = cover(left, cameras, self._places, settings)
        while (doubtful := suspect(agreements(bodies, left, cameras))) is not None:
            fewer = {name: found for name, found in left.items() if name != doubtful}
            without = cover(fewer, cameras, self._places, settings)
            wrong = alarm(doubtful, without, left, cameras)
            if wrong is None:
                break
            alarms.append(wrong)
            left, bodies = fewer, without
        return bodies, tuple(alarms)

    def _located(self, locator: Locator, pictures: Pictures, number: int) -> list[Body]:
        height = self.scene.cylinder.height
        found = locator.locate(pictures, self.scene.cameras, self.scene.grid, number)
        return [Body(np.array([x, y]), height, _worth(score), {}, np.eye(2) * 0.04) for x, y, score in found]

    def _occupied(self, masks: Foregrounds) -> list[Body]:
        if not masks:
            return []
        settings, height = self.settings.pom, self.scene.cylinder.height
        chance = occupancy(self._frames, masks, settings)
        return [
            Body(self._positions[row], height, _worth(float(chance[row])), {}, np.eye(2) * settings.step**2)
            for row in peaks(self._positions, chance, settings)
        ]

    def _projected(self, boxes: Boxes) -> list[Body]:
        height = self.scene.cylinder.height
        clusters = projected(boxes, self.scene.cameras, self.settings.projected)
        return [Body(each.xy, height, _worth(each.score), each.boxes, np.eye(2) * 0.04) for each in clusters]

    def _proposals(
        self, bodies: list[Body], boxes: Boxes, masks: Foregrounds, around: list[Body]
    ) -> list[Proposal]:
        cylinder, sitting = self.scene.cylinder, self.settings.cover.sitting
        return [
            Proposal(
                x=float(body.xy[0]),
                y=float(body.xy[1]),
                height=round(body.height, 2),
                radius=cylinder.radius,
                score=round(_score(body.worth), 3),
                evidence=evidence_for(body, around, boxes, masks, self.scene.cameras),
                method=self.method.value,
                seated=body.height < sitting,
            )
            for body in bodies
        ]


def propose(
    pictures_by_frame: Sequence[Pictures],
    cameras: Mapping[str, Camera],
    grid: Grid,
    *,
    method: Method | str = Method.COVER,
    detector: Detector | None = None,
    settings: Settings | None = None,
    cylinder: Cylinder | None = None,
    rule: FootRule = FootRule.CORNERS,
    report: Callable[[int], None] | None = None,
) -> list[FrameProposals]:
    """Of all frames together, whose pictures may be read when asked for; reports frames done."""
    scene = Scene(cameras, grid, cylinder or STANDARD, rule)
    backgrounds = Backgrounds.learn(pictures_by_frame, cameras)
    proposer = Proposer(scene, Method(method), detector, settings or Settings(), backgrounds)
    found = []
    for done, pictures in enumerate(pictures_by_frame, start=1):
        found.append(proposer.frame(pictures))
        if report is not None:
            report(done)
    return found


def usable_method(method: Method | str, detector: Detector | Locator | None) -> Method:
    """The method that can be used: without a detector the background is all there is, and who says places
    needs no boxes."""
    wanted = Method(method)
    if isinstance(detector, Locator):
        return Method.LOCATED if wanted is Method.COVER else wanted
    return Method.BACKGROUND if detector is None and wanted is Method.COVER else wanted


def _scaled(boxes: Sequence[Box], factor: float) -> list[Box]:
    return [Box(x1 * factor, y1 * factor, x2 * factor, y2 * factor, score) for x1, y1, x2, y2, score in boxes]


def _score(worth: float) -> float:
    return 1 / (1 + math.exp(-(worth - EVEN) / SLOPE))


def _worth(score: float) -> float:
    """Inverse of `_score`, for methods that know a probability."""
    chance = min(max(score, 1e-6), 1 - 1e-6)
    return EVEN + SLOPE * math.log(chance / (1 - chance))


def _occupancy_grid(scene: Scene, settings: PomSettings) -> tuple[Floats, dict[str, Frames]]:
    """Places (N, 2) of every so-manieth position, and their rectangles in the views."""
    ids = steps_of(scene.grid, settings.step)
    frames = {}
    for name, camera in scene.cameras.items():
        boxes, _ = rectangles(camera, scene.grid, scene.cylinder, scene.rule, ids)
        frames[name] = Frames(boxes, (camera.width, camera.height), settings.width)
    return scene.grid.metres(ids), frames
