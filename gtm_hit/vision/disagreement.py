"""A camera that contradicts all others: where they see people, it has none, and its own stand elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from gtm_hit.geometry.camera import Camera, Floats, back_project
from gtm_hit.vision.bodies import body_boxes
from gtm_hit.vision.boxes import Box, as_array
from gtm_hit.vision.cover import Body
from gtm_hit.vision.people import CameraAlarm
from gtm_hit.vision.sights import Sight, SightSettings

SUSPECTED = 2  # people whom others place in its picture, for a camera to be suspected,
FEWEST = 3  # and to be accused, once they are found without it
DOUBTFUL = 0.5  # share of them it must have boxed not to be suspected,
AGREES = 0.25  # and not to be accused
OTHERS = 0.5  # share that the other cameras box of theirs, lest the detector be to blame
WHOLE = 0.8  # share of a body in the picture for it to be expected there
CLEAR = 40.0  # pixels a body must be tall
STRONG = 0.5  # a box that surely shows somebody
FURTHEST = 6.0  # metres within which a camera's own people are looked for


@dataclass(frozen=True)
class Agreement:
    expected: int  # people whom this camera should see, as two others say
    boxed: int  # those it has boxed

    @property
    def share(self) -> float:
        return self.boxed / self.expected if self.expected else 1.0


def agreements(
    bodies: Sequence[Body], boxes: Mapping[str, Sequence[Box]], cameras: Mapping[str, Camera]
) -> dict[str, Agreement]:
    """How far each camera agrees with what at least two others say."""
    found = {}
    for name in boxes:
        told = _expected_in(name, bodies, boxes, cameras)
        found[name] = Agreement(len(told), sum(name in body.boxes for body in told))
    return found


def suspect(agreed: Mapping[str, Agreement]) -> str | None:
    """The camera that agrees least, if that is little and the others agree with each other."""
    known = {name: each for name, each in agreed.items() if each.expected >= SUSPECTED}
    if len(known) < 3:
        return None
    worst = min(known, key=lambda name: known[name].share)
    rest = [each.share for name, each in known.items() if name != worst]
    return worst if known[worst].share < DOUBTFUL and np.median(rest) >= OTHERS else None


def alarm(
    name: str, bodies: Sequence[Body], boxes: Mapping[str, Sequence[Box]], cameras: Mapping[str, Camera]
) -> CameraAlarm | None:
    """What is to be said about a suspected camera, `bodies` being found without it; None if it is right."""
    told = _expected_in(name, bodies, boxes, cameras)
    found = as_array(list(boxes[name]))
    strong = found[found[:, 4] >= STRONG]
    if len(told) < FEWEST or len(strong) == 0:
        return None
    places = np.array([[*body.xy, body.height] for body in told])
    sight = Sight(cameras[name], found, SightSettings())
    agree = sight.worths(sight.expected(places)).max(axis=1) > 0
    if agree.mean() >= AGREES:
        return None
    metres = _distance(places[:, :2], strong, cameras[name])
    said = f"about {metres:.0f} m" if metres >= 1 else f"about {metres * 100:.0f} cm"
    off = f"; the people it sees stand {said} elsewhere" if np.isfinite(metres) else ""
    count = f"{int(agree.sum())} of the {len(told)} people"
    why = f"{name} confirms {count} whom the other cameras place in its picture{off}. Its pose seems off."
    return CameraAlarm(name, metres, why)


def _expected_in(
    name: str, bodies: Sequence[Body], boxes: Mapping[str, Sequence[Box]], cameras: Mapping[str, Camera]
) -> list[Body]:
    """Bodies that two other cameras box and this one should see: in its picture and not hidden."""
    sure = [body for body in bodies if len(body.boxes.keys() - {name}) >= 2]
    if not sure:
        return []
    places = np.array([[*body.xy, body.height] for body in sure])
    sight = Sight(cameras[name], as_array(list(boxes[name])), SightSettings())
    expected = sight.expected(places)
    tall = expected.whole[:, 3] - expected.whole[:, 1]
    clear = (expected.share >= WHOLE) & (tall >= CLEAR) & ~sight.hidden(places, expected, places)
    return [body for body, seen in zip(sure, clear.tolist(), strict=True) if seen]


def _distance(places: Floats, found: Floats, camera: Camera) -> float:
    """Median metres from places (N, 2) to the nearest foot the camera sees, in a picture of like size."""
    feet = back_project(camera, np.column_stack(((found[:, 0] + found[:, 2]) / 2, found[:, 3])))
    expected = body_boxes(camera, feet, 0.2, 1.72).whole
    like = (found[:, 3] - found[:, 1]) / (expected[:, 3] - expected[:, 1])
    feet = feet[np.isfinite(feet).all(axis=1) & (like > 0.6) & (like < 1.6)]
    if not len(feet):
        return float("nan")
    away = np.hypot(*(places[:, None] - feet[None]).transpose(2, 0, 1)).min(axis=1)
    near = away[away < FURTHEST]
    return float(np.median(near)) if len(near) else float("nan")
