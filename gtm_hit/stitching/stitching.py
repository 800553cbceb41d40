"""The whole way: replicas fused, neighbours joined, what was decided applied, returners proposed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from gtm_hit.stitching.fusing import Disagreement, fuse
from gtm_hit.stitching.joining import Chain, Doubt, join
from gtm_hit.stitching.merging import merged
from gtm_hit.stitching.returning import Return, linked, returners
from gtm_hit.stitching.rules import Rules
from gtm_hit.stitching.tracks import Batch, Track
from gtm_hit.stitching.verdicts import Verdict, Verdicts


@dataclass(frozen=True, eq=False)
class Stitched:
    people: list[Track]  # one per person, by who came first
    doubts: list[Doubt]
    returns: list[Return]
    disagreements: list[list[Disagreement]]  # per group of replicas, per replica
    joins: int


def stitch(
    groups: Sequence[Sequence[Batch]],
    rules: Rules,
    verdicts: Sequence[Verdict] = (),
    told: Callable[[int, int], object] = lambda done, total: None,
) -> Stitched:
    """One layer out of batches; a group holds the replicas of one batch."""
    fused, steps = [], 2 * len(groups)
    for done, group in enumerate(groups, start=1):
        fused.append(fuse(group, rules))
        told(done, steps)
    said = Verdicts(verdicts)
    batches = [each.batch for each in fused]
    joined = join(batches, rules, said, lambda done, total: told(len(groups) + done, steps))
    people = linked(joined.chains, verdicts)
    returns = returners(people, rules, said)
    tracks = sorted((_whole(person) for person in people), key=lambda track: track.place_in_order)
    return Stitched(tracks, joined.doubts, returns, [each.disagreements for each in fused], joined.joins)


def _whole(person: Sequence[Chain]) -> Track:
    return merged([track for chain in person for track in chain.tracks])
