"""What proposals are measured by: people per frame, and people followed through the frames.

People whom the annotations cannot know, because they stand beyond the annotated strip, are left out of both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.proposal_scenes import Example
from gtm_hit.metrics import detection, tracking
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.vision.link import FILLED, NOBODY, for_pace
from gtm_hit.vision.people import FrameProposals
from gtm_hit.vision.windows import linked_in_windows

ALONE = 0.75  # least score of somebody whom no other frame confirms: as in a layer made of proposals
SECONDS = 0.5  # from frame to frame, in all that is scored here

Found = Sequence[FrameProposals]


@dataclass(frozen=True)
class LinkedScore:
    detection: detection.DetectionScore
    tracking: tracking.TrackingScore


def per_frame(
    example: Example, found: Found, frames: Sequence[int] | None = None
) -> detection.DetectionScore:
    places, xy, _scores = columns(found)
    return detection.evaluate(truth_of(example, frames), _countable(example, Annotations(places, xy), frames))


def linked(example: Example, found: Found) -> LinkedScore:
    truth, followed = truth_of(example), _countable(example, followed_people(found))
    return LinkedScore(detection.evaluate(truth, followed), tracking.evaluate(truth, followed).score)


def followed_people(found: Found) -> Annotations:
    """Tracks with their filled holes, and whoever is sure enough without one."""
    frames, xy, scores = columns(found)
    followed = linked_in_windows(frames, xy, for_pace(SECONDS))
    tracks = np.full(len(frames), NOBODY)
    own = followed.rows != FILLED
    tracks[followed.rows[own]] = followed.tracks[own]
    alone = np.flatnonzero((tracks == NOBODY) & (scores >= ALONE))
    numbers = followed.tracks.max(initial=0) + 1 + np.arange(len(alone))
    return Annotations(
        np.concatenate((followed.frames, frames[alone])),
        np.concatenate((followed.xy, xy[alone])),
        np.concatenate((followed.tracks, numbers)),
    )


def truth_of(example: Example, frames: Sequence[int] | None = None) -> Annotations:
    chosen = [(frame, known) for frame, known in example.known.items() if frames is None or frame in frames]
    return Annotations(
        np.concatenate([np.full(len(known.xy), frame) for frame, known in chosen]),
        np.concatenate([known.xy for _frame, known in chosen]),
        np.concatenate([known.persons for _frame, known in chosen]),
    )


def columns(found: Found) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rows = [(frame, each) for frame, proposed in enumerate(found) for each in proposed.people]
    return (
        np.array([frame for frame, _each in rows], np.int64),
        np.array([(each.x, each.y) for _frame, each in rows]).reshape(-1, 2),
        np.array([each.score for _frame, each in rows]),
    )


def _countable(example: Example, found: Annotations, frames: Sequence[int] | None = None) -> Annotations:
    """Of annotated frames, without whom the annotations could not know."""
    kept = np.zeros(len(found), bool)
    for frame, known in example.known.items():
        if frames is None or frame in frames:
            rows = np.flatnonzero(found.frames == frame)
            kept[rows] = is_annotated(example, found.xy[rows], known.xy)
    persons = None if found.persons is None else found.persons[kept]
    return Annotations(found.frames[kept], found.xy[kept], persons)


def is_annotated(example: Example, xy: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Whom the annotations could know: inside, or so near the line that somebody annotated may be meant."""
    if not np.isfinite(example.ends) or not len(xy):
        return np.ones(len(xy), bool)
    at_line = known[known[:, 1] > example.ends - RADIUS]
    near = np.hypot(*(xy[:, None] - at_line[None]).transpose(2, 0, 1)) < RADIUS
    inside = xy[:, 1] < example.ends
    # Somebody annotated just inside whose proposal lies inside needs none from beyond.
    alone = ~(near & inside[:, None]).any(axis=0) if len(at_line) else np.zeros(0, bool)
    return inside | (near & alone[None]).any(axis=1)
