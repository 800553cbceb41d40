"""Numbers of people that stay what they were when stitching runs again."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from gtm_hit.models import Layer, StitchedFrame
from gtm_hit.ops.frames.saving import next_person
from gtm_hit.stitching.tracks import Source, Track

FRAMES_AT_ONCE = 500


def numbers(layer: Layer, people: Sequence[Track], frames: Sequence[int]) -> list[int]:
    """Per person the number most of its annotations had last time; a new one for everybody else.

    frames : ids, by instant
    """
    common = _common(layer, people, frames)
    chosen: dict[int, int] = {}
    taken: set[int] = set()
    for (index, number), _ in sorted(common.items(), key=lambda each: (-each[1], each[0])):
        if index not in chosen and number not in taken:
            chosen[index] = number
            taken.add(number)
    following = next_person(layer)
    for index in range(len(people)):
        if index not in chosen:
            chosen[index], following = following, following + 1
    return [chosen[index] for index in range(len(people))]


def _common(layer: Layer, people: Sequence[Track], frames: Sequence[int]) -> Counter[tuple[int, int]]:
    """How many annotations each person shares with each number of last time."""
    now: dict[int, dict[Source, int]] = {}
    for index, track in enumerate(people):
        for frame, votes in zip(track.frames.tolist(), track.votes, strict=True):
            now.setdefault(frames[frame], {}).update(dict.fromkeys(votes, index))
    common: Counter[tuple[int, int]] = Counter()
    before = StitchedFrame.objects.filter(layer=layer).values_list("frame_id", "sources")
    for frame, sources in before.iterator(FRAMES_AT_ONCE):
        there = now.get(frame, {})
        for number, *flat in sources:
            for source in pairs(flat):
                if source in there:
                    common[there[source], number] += 1
    return common


def pairs(flat: Sequence[int]) -> list[Source]:
    """Sources as they are kept: layer, person, layer, person …"""
    return list(zip(flat[::2], flat[1::2], strict=True))
