"""Reading and saving frames of layers. A save replaces one frame; what it replaces stays in the history."""

from __future__ import annotations

import uuid
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from datetime import datetime
from typing import Any

from django.contrib.auth.models import AbstractBaseUser
from django.db import IntegrityError, transaction
from django.db.models import F, Func, IntegerField, Max, QuerySet
from django.utils import timezone

from gtm_hit.models import Annotation, Frame, Layer, LayerFrame, Save, Worker
from gtm_hit.ops.calibration.versions import in_place_id
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.frames.row import FIELDS, Row
from gtm_hit.ops.frames.rules import checked
from gtm_hit.ops.pay import clock
from gtm_hit.ops.work import leases

Author = Worker | AbstractBaseUser | None


@dataclass(frozen=True)
class FrameState:
    """One frame of one layer as it is, or as it was after some save."""

    number: int
    revision: int
    annotations: list[Row]
    done: bool
    nobody: bool
    saved_at: datetime | None
    author: str

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


@dataclass(frozen=True)
class Revision:
    revision: int
    created_at: datetime
    author: str
    people: int
    done: bool
    calibration: int | None  # number of the version in place then; None: not known


class StaleSave(OperationError):
    """Somebody saved the frame since this edit started; `current` is what is there now."""

    def __init__(self, current: FrameState) -> None:
        super().__init__(f"frame {current.number} is at revision {current.revision}")
        self.current = current


class SaveIdUsed(OperationError):
    """The save's id names another save: taking it for a repetition would lose this one."""


class UnknownRevision(OperationError, LookupError):
    """The frame never had this revision."""


class JsonLength(Func):
    """Number of elements of a JSON list, counted by the database."""

    function = "JSONB_ARRAY_LENGTH"
    output_field = IntegerField()

    def as_sqlite(self, compiler: Any, connection: Any, **extra: Any) -> Any:
        return super().as_sql(compiler, connection, function="JSON_ARRAY_LENGTH", **extra)


def save_frame(
    layer: Layer,
    frame: Frame,
    author: Author,
    save_id: uuid.UUID,
    revision: int,
    annotations: object,
    *,
    done: bool = False,
    nobody: bool = False,
    seconds: object = 0.0,
) -> FrameState:
    """Replace the frame and append to its history; the same `save_id` again answers as before.

    Raises InvalidFrame, StaleSave, SaveIdUsed, or ReadOnly for a worker's layer that may not be changed now.
    """
    if frame.dataset_id != layer.dataset_id:
        raise ValueError(f"frame {frame.pk} is not in the dataset of layer {layer.pk}")
    rows, active = checked(annotations, layer.dataset.grid, done=done, nobody=nobody, seconds=seconds)
    save = Save(
        revision=revision + 1,
        save_id=save_id,
        annotations=[row.as_dict() for row in rows],
        done=done,
        nobody=nobody,
        seconds=active,
        user=author if isinstance(author, AbstractBaseUser) else None,  # type: ignore[misc]
        worker=author if isinstance(author, Worker) else None,
    )
    try:
        with transaction.atomic():
            return write_save(layer, frame, save, rows)
    except IntegrityError:
        # Two frames were saved under one id at the same moment; the database let one of them in.
        if Save.objects.filter(save_id=save_id).exists():
            raise SaveIdUsed from None
        raise


def write_save(layer: Layer, frame: Frame, save: Save, rows: list[Row]) -> FrameState:
    # Always in this order, assignment then frame: two orders would let two requests wait for each other.
    assignment = leases.locked_for_layer(layer)
    head, _created = LayerFrame.objects.select_for_update(no_key=True).get_or_create(layer=layer, frame=frame)
    if repeated := Save.objects.select_related("worker", "user").filter(save_id=save.save_id).first():
        return repeated_answer(repeated, save, head, frame)
    leases.require_editable(layer, assignment, save.worker)
    if head.revision != save.revision - 1:
        raise StaleSave(read_frame(layer, frame))
    write_rows(layer, frame, rows)
    if assignment is not None:
        save.seconds = clock.believed(assignment, save.seconds, timezone.now())
    save.layer_frame = head
    save.calibration_id = in_place_id(layer.dataset_id)
    save.save(force_insert=True)
    LayerFrame.objects.filter(pk=head.pk).update(
        revision=save.revision,
        done=save.done,
        nobody=save.nobody,
        seconds=F("seconds") + save.seconds,
        changed_at=timezone.now(),
    )
    if assignment is not None:
        leases.extend(assignment)
    return state_of(save, frame)


def repeated_answer(repeated: Save, save: Save, head: LayerFrame, frame: Frame) -> FrameState:
    same = repeated.layer_frame_id == head.pk and all(
        getattr(repeated, name) == getattr(save, name)
        for name in ("revision", "annotations", "done", "nobody")
    )
    if not same:
        raise SaveIdUsed
    return state_of(repeated, frame)


def write_rows(layer: Layer, frame: Frame, rows: list[Row]) -> None:
    """Touch only what differs; remember the largest person number ever used."""
    present = Annotation.objects.filter(layer=layer, frame=frame).order_by()
    before = {pk: Row(*values) for pk, *values in present.values_list("pk", *FIELDS)}
    known = {row.person: row for row in before.values()}
    kept = {row.person for row in rows}
    gone = [pk for pk, row in before.items() if row.person not in kept]
    if gone:
        Annotation.objects.filter(pk__in=gone).delete()
    changed = [row for row in rows if known.get(row.person) != row]
    Annotation.objects.bulk_create(
        [Annotation(layer=layer, frame=frame, **row.as_dict()) for row in changed],
        update_conflicts=True,
        unique_fields=["layer", "frame", "person"],
        update_fields=[name for name in FIELDS if name != "person"],
    )
    largest = max(kept | known.keys(), default=0)
    Layer.objects.filter(pk=layer.pk, last_person__lt=largest).update(last_person=largest)


def rows_by_frame(annotations: QuerySet[Annotation], frame_ids: Iterable[int]) -> dict[int, list[Row]]:
    """By person; an empty list for a frame with nobody in it."""
    rows: dict[int, list[Row]] = {pk: [] for pk in frame_ids}
    found = annotations.filter(frame__in=list(rows)).order_by("person")
    for frame_id, *values in found.values_list("frame_id", *FIELDS):
        rows[frame_id].append(Row(*values))
    return rows


def state_of(save: Save, frame: Frame) -> FrameState:
    return FrameState(
        number=frame.number,
        revision=save.revision,
        annotations=[Row.from_dict(row) for row in save.annotations],
        done=save.done,
        nobody=save.nobody,
        saved_at=save.created_at,
        author=author_name(save.worker, save.user),
    )


def author_name(worker: Worker | None, user: Any) -> str:
    if worker is not None:
        return worker.pseudonym
    return user.get_username() if user is not None else ""


def read_frame(layer: Layer, frame: Frame) -> FrameState:
    return read_frames(layer, [frame])[0]


def read_frames(layer: Layer, frames: Iterable[Frame]) -> list[FrameState]:
    """The frames' present states, in the given order, with three queries."""
    frames = list(frames)
    ids = [frame.pk for frame in frames]
    heads = {head.frame_id: head for head in LayerFrame.objects.filter(layer=layer, frame__in=ids)}
    newest = {save.layer_frame_id: save for save in newest_saves(layer, ids)}
    rows = rows_by_frame(Annotation.objects.filter(layer=layer), ids)
    return [present_state(frame, heads.get(frame.pk), newest, rows[frame.pk]) for frame in frames]


def newest_saves(layer: Layer, frame_ids: list[int]) -> Iterable[Save]:
    saves = Save.objects.filter(layer_frame__layer=layer, layer_frame__frame__in=frame_ids)
    saves = saves.filter(revision=F("layer_frame__revision")).select_related("worker", "user")
    return saves.defer("annotations")


def present_state(
    frame: Frame, head: LayerFrame | None, newest: dict[int, Save], rows: list[Row]
) -> FrameState:
    save = newest.get(head.pk) if head else None
    return FrameState(
        number=frame.number,
        revision=head.revision if head else 0,
        annotations=rows,
        done=bool(head and head.done),
        nobody=bool(head and head.nobody),
        saved_at=save.created_at if save else None,
        author=author_name(save.worker, save.user) if save else "",
    )


def history(layer: Layer, frame: Frame) -> list[Revision]:
    """Every save of the frame, oldest first; the annotations themselves are not loaded."""
    saves = Save.objects.filter(layer_frame__layer=layer, layer_frame__frame=frame)
    saves = saves.select_related("worker", "user").defer("annotations").order_by("revision")
    counted = saves.annotate(people=JsonLength("annotations"), version=F("calibration__number"))
    return [
        Revision(
            revision=save.revision,
            created_at=save.created_at,
            author=author_name(save.worker, save.user),
            people=save.people,
            done=save.done,
            calibration=save.version,
        )
        for save in counted
    ]


def state_at(layer: Layer, frame: Frame, revision: int) -> FrameState:
    """The frame as the save with this revision left it; raises UnknownRevision."""
    if revision == 0:
        return FrameState(frame.number, 0, [], False, False, None, "")
    saves = Save.objects.filter(layer_frame__layer=layer, layer_frame__frame=frame, revision=revision)
    save = saves.select_related("worker", "user").first()
    if save is None:
        raise UnknownRevision(f"frame {frame.number} has no revision {revision}")
    return state_of(save, frame)


def next_person(layer: Layer) -> int:
    """A number no save of the layer has ever used: numbers of removed people stay theirs."""
    used = Layer.objects.filter(pk=layer.pk).aggregate(
        kept=Max("last_person"), present=Max("annotations__person")
    )
    return max(used["kept"] or 0, used["present"] or 0) + 1
