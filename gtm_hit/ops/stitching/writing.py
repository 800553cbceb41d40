"""The layer's frames as stitching wants them; what is equal is not touched, what people changed stays."""

from __future__ import annotations

import uuid
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from django.contrib.auth.models import User
from django.db import transaction
from django.utils import timezone

from gtm_hit.models import Annotation, Layer, LayerFrame, Save, StitchedFrame
from gtm_hit.ops.calibration.versions import in_place_id
from gtm_hit.ops.datasets.insert import insert
from gtm_hit.ops.frames.row import FIELDS, Row
from gtm_hit.ops.frames.saving import rows_by_frame
from gtm_hit.ops.jobs.progress import Progress
from gtm_hit.stitching.tracks import Source

WRITING_LAYER = "writing the layer"
FRAMES_AT_ONCE = 250
MOST_ROWS = 2000

Wanted = list[tuple[int, int, tuple[Source, ...]]]  # person, position, what it was made of


@dataclass
class Written:
    changed: int = 0  # frames
    same: int = 0
    emptied: int = 0  # frames no accepted batch covers any more
    by_hand: list[int] = field(default_factory=list)  # ids of frames people changed since


@dataclass(frozen=True)
class _Now:
    """What the layer holds of some frames."""

    heads: Mapping[int, LayerFrame]
    stitched: Mapping[int, StitchedFrame]
    rows: Mapping[int, list[Row]]


def write(layer: Layer, wanted: Mapping[int, Wanted], user: User | None, report: Progress) -> Written:
    """wanted : by frame id, for every frame that is covered; other frames stitching wrote are emptied."""
    known = set(StitchedFrame.objects.filter(layer=layer).values_list("frame_id", flat=True))
    frames = sorted({*wanted, *known})
    written = Written()
    for start in range(0, len(frames), FRAMES_AT_ONCE):
        report(WRITING_LAYER, start, len(frames))
        with transaction.atomic():
            Layer.objects.select_for_update(no_key=True).get(pk=layer.pk)
            _write_some(layer, frames[start : start + FRAMES_AT_ONCE], wanted, user, written)
    report(WRITING_LAYER, len(frames), len(frames))
    return written


def _write_some(
    layer: Layer, frames: list[int], wanted: Mapping[int, Wanted], user: User | None, written: Written
) -> None:
    now = _now(layer, frames)
    made = _rows(wanted, frames)
    changed, kept = [], []
    for frame in frames:
        if _by_hand(now.heads.get(frame), now.stitched.get(frame)):
            written.by_hand.append(frame)
        elif frame in now.heads and made[frame] == now.rows[frame]:
            kept.append(frame)
        else:
            changed.append(frame)
    _replace(layer, changed, made, wanted, now, user)
    _remember(layer, changed + kept, wanted, now)
    gone = [frame for frame in changed + kept if frame not in wanted]
    StitchedFrame.objects.filter(layer=layer, frame__in=gone).delete()
    written.changed += len(changed)
    written.same += len(kept)
    written.emptied += len(gone)


def _now(layer: Layer, frames: list[int]) -> _Now:
    heads = LayerFrame.objects.select_for_update(no_key=True).filter(layer=layer, frame__in=frames)
    stitched = StitchedFrame.objects.filter(layer=layer, frame__in=frames)
    return _Now(
        {head.frame_id: head for head in heads},
        {each.frame_id: each for each in stitched},
        rows_by_frame(Annotation.objects.filter(layer=layer), frames),
    )


def _by_hand(head: LayerFrame | None, stitched: StitchedFrame | None) -> bool:
    left_at = stitched.revision if stitched else 0
    return head is not None and head.revision > left_at


def _rows(wanted: Mapping[int, Wanted], frames: Sequence[int]) -> dict[int, list[Row]]:
    """By frame, the people by number, each like the annotations it was made of."""
    layers = {source[0] for frame in frames for _, _, votes in wanted.get(frame, []) for source in votes}
    found = Annotation.objects.filter(layer__in=layers, frame__in=frames).order_by()
    sources = {
        (frame, layer, values[0]): Row(*values)
        for frame, layer, *values in found.values_list("frame_id", "layer_id", *FIELDS)
    }
    return {
        frame: sorted(
            (
                _row(person, position, [sources[frame, *vote] for vote in votes])
                for person, position, votes in wanted.get(frame, [])
            ),
            key=lambda row: row.person,
        )
        for frame in frames
    }


def _row(person: int, position: int, votes: Sequence[Row]) -> Row:
    """Validated where one of them is; of their sizes and origins the most frequent."""
    validated = Annotation.State.VALIDATED.value
    state = validated if any(vote.state == validated for vote in votes) else votes[0].state
    origin = Counter(vote.origin for vote in votes).most_common(1)[0][0]
    height, radius = Counter((vote.height, vote.radius) for vote in votes).most_common(1)[0][0]
    return Row(person, position, state, origin, height, radius)


def _replace(
    layer: Layer,
    frames: list[int],
    made: Mapping[int, list[Row]],
    wanted: Mapping[int, Wanted],
    now: _Now,
    user: User | None,
) -> None:
    missing = [LayerFrame(layer=layer, frame_id=frame) for frame in frames if frame not in now.heads]
    heads = {**now.heads, **{head.frame_id: head for head in LayerFrame.objects.bulk_create(missing)}}
    changed = [heads[frame] for frame in frames]
    calibration = in_place_id(layer.dataset_id)
    for head in changed:
        rows = made[head.frame_id]
        head.revision += 1
        head.nobody = not rows and head.frame_id in wanted
        head.done = head.nobody or (
            bool(rows) and all(row.state == Annotation.State.VALIDATED for row in rows)
        )
        head.changed_at = timezone.now()
    Save.objects.bulk_create(
        Save(
            layer_frame=head,
            revision=head.revision,
            save_id=uuid.uuid4(),
            annotations=[row.as_dict() for row in made[head.frame_id]],
            done=head.done,
            nobody=head.nobody,
            user=user,
            calibration_id=calibration,
        )
        for head in changed
    )
    LayerFrame.objects.bulk_update(
        changed, ["revision", "done", "nobody", "changed_at"], batch_size=MOST_ROWS
    )
    Annotation.objects.filter(layer=layer, frame__in=frames).delete()
    columns = [(layer.pk, frame, *row.values()) for frame in frames for row in made[frame]]
    insert(Annotation, ("layer_id", "frame_id", *FIELDS), columns)
    largest = max((row.person for frame in frames for row in made[frame]), default=0)
    Layer.objects.filter(pk=layer.pk, last_person__lt=largest).update(last_person=largest)
    now.heads.update(heads)  # type: ignore[attr-defined]


def _remember(layer: Layer, frames: list[int], wanted: Mapping[int, Wanted], now: _Now) -> None:
    """Where the people of the frames come from now."""
    rows = []
    for frame in frames:
        if frame not in wanted:
            continue
        sources = [
            [person, *(number for vote in votes for number in vote)]
            for person, _, votes in sorted(wanted[frame])
        ]
        revision, before = now.heads[frame].revision, now.stitched.get(frame)
        if before is None or before.sources != sources or before.revision != revision:
            rows.append(StitchedFrame(layer=layer, frame_id=frame, revision=revision, sources=sources))
    StitchedFrame.objects.bulk_create(
        rows,
        batch_size=MOST_ROWS,
        update_conflicts=True,
        unique_fields=["layer", "frame"],
        update_fields=["revision", "sources"],
    )
