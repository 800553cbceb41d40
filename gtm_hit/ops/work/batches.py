"""Cutting a dataset's frames into batches, any number of times, with the same result."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from django.db import transaction
from django.utils.translation import gettext as _

from gtm_hit.models import Batch, Dataset, Frame
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.proposals import job as proposals

MAX_SIZE = 500
MAX_COPIES = 20


class BatchError(OperationError, ValueError):
    """A size or a number of copies that makes no batches."""


def make_batches(dataset: Dataset, size: int = 10, copies: int = 1) -> int:
    """Batch the frames that are in no batch yet and add missing copies; the number of batches added.

    Existing batches stay as they are, so a batch number means the same frames in every copy for ever.
    """
    if not 1 <= size <= MAX_SIZE:
        raise BatchError(_("A batch has 1 to %(most)d frames.") % {"most": MAX_SIZE})
    if not 1 <= copies <= MAX_COPIES:
        raise BatchError(_("Make 1 to %(most)d copies of a batch.") % {"most": MAX_COPIES})
    with transaction.atomic():
        # Two people pressing the button at once queue here.
        Dataset.objects.select_for_update(no_key=True).get(pk=dataset.pk)
        frames_of, copies_of = existing(dataset)
        number = max(frames_of, default=0)
        for chunk in new_chunks(dataset, {frame for ids in frames_of.values() for frame in ids}, size):
            number += 1
            frames_of[number], copies_of[number] = chunk, set()
        added = add_copies(dataset, frames_of, copies_of, copies)
        if added:
            proposals.start_by_itself(dataset)
        return added


def existing(dataset: Dataset) -> tuple[dict[int, list[int]], dict[int, set[int]]]:
    """Per batch number its frames' ids and the copies there are."""
    frames_of: dict[int, list[int]] = {}
    copies_of: dict[int, set[int]] = {}
    for number, copy in Batch.objects.filter(dataset=dataset, campaign=None).values_list("number", "copy"):
        frames_of.setdefault(number, [])
        copies_of.setdefault(number, set()).add(copy)
    first = {number: min(there) for number, there in copies_of.items()}
    links = Batch.frames.through.objects.filter(
        batch__dataset=dataset, batch__campaign=None, batch__qualification=None
    )
    for number, copy, frame in links.values_list("batch__number", "batch__copy", "frame_id"):
        if copy == first[number]:
            frames_of[number].append(frame)
    return frames_of, copies_of


def new_chunks(dataset: Dataset, taken: set[int], size: int) -> Iterator[list[int]]:
    """Runs of at most `size` frames that follow each other, of the frames not taken."""
    chunk: list[int] = []
    for frame in Frame.objects.filter(dataset=dataset).order_by("number").values_list("pk", flat=True):
        if chunk and (frame in taken or len(chunk) == size):
            yield chunk
            chunk = []
        if frame not in taken:
            chunk.append(frame)
    if chunk:
        yield chunk


def add_copies(
    dataset: Dataset, frames_of: dict[int, list[int]], copies_of: dict[int, set[int]], copies: int
) -> int:
    missing = [
        Batch(dataset=dataset, number=number, copy=copy)
        for number in sorted(frames_of)
        for copy in range(1, copies + 1)
        if copy not in copies_of[number]
    ]
    return write(missing, frames_of)


def write(missing: list[Batch], frames_of: dict[int, list[int]]) -> int:
    """The rows of batches that are not there yet, with the frames of their numbers; how many."""
    Batch.objects.bulk_create(missing)
    links: Iterable[tuple[int, int]] = (
        (batch.pk, frame) for batch in missing for frame in frames_of[batch.number]
    )
    through = Batch.frames.through
    through.objects.bulk_create(
        [through(batch_id=batch, frame_id=frame) for batch, frame in links], batch_size=5000
    )
    return len(missing)
