"""Why a proposal is believed, view by view."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from gtm_hit.geometry.camera import Camera, Floats
from gtm_hit.vision.bodies import body_boxes
from gtm_hit.vision.boxes import Box
from gtm_hit.vision.cover import Body
from gtm_hit.vision.people import Evidence
from gtm_hit.vision.sights import Sight, SightSettings

Foregrounds = dict[str, NDArray[np.float32]]

RADIUS = 0.12  # metres: narrow, so that what is beside a body does not count
PARTLY = 0.3  # share of a body in the picture from which a view has a say


def evidence_for(
    body: Body,
    around: Sequence[Body],
    boxes: Mapping[str, Sequence[Box]],
    foregrounds: Foregrounds,
    cameras: Mapping[str, Camera],
) -> tuple[Evidence, ...]:
    """Of every view whose picture the body is in."""
    place = np.array([[*body.xy, body.height]])
    others = np.array([[*each.xy, each.height] for each in around if each is not body]).reshape(-1, 3)
    said = []
    for name, camera in cameras.items():
        expected = body_boxes(camera, place[:, :2], RADIUS, body.height)
        box = boxes[name][body.boxes[name]] if name in body.boxes else None
        if box is None and expected.share[0] < PARTLY:
            continue
        sight = Sight(camera, np.zeros((0, 5)), SightSettings())
        hidden = bool(sight.hidden(place, expected, others)[0])
        seen = _seen(foregrounds.get(name), expected.boxes[0], camera)
        said.append(Evidence(name, None if box is None else (*box[:4],), seen, hidden))
    return tuple(said)


def _seen(mask: NDArray | None, box: Floats, camera: Camera) -> float:
    """Share of a box that is not background; NaN where that is unknown."""
    if mask is None:
        return float("nan")
    x1, y1, x2, y2 = np.rint(box * mask.shape[1] / camera.width).astype(int)
    part = mask[y1:y2, x1:x2]
    return round(float(part.mean()), 3) if part.size else float("nan")
