"""A run's people as a layer, to be compared, looked at and exported like any other."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from itertools import count

import numpy as np
from django.core.exceptions import ValidationError
from django.db import IntegrityError, transaction
from django.db.models import Q
from django.utils.translation import gettext as _

from gtm_hit.models import Annotation, Dataset, Layer, Proposal, ProposalRun
from gtm_hit.ops.datasets import rows
from gtm_hit.ops.datasets.annotations import ImportedFrame
from gtm_hit.ops.layers import unfinished
from gtm_hit.ops.proposals.errors import ProposalError

THRESHOLD = 0.5  # of the score, from which on somebody is taken for real
ALONE = 0.75  # the same for somebody whom no other frame confirms, where there are other frames
COLUMNS = ("proposal_frame__frame__number", "position", "height", "radius", "track")


def check_name(dataset: Dataset, name: str) -> None:
    """Raises ProposalError for a name that no layer of the dataset can get."""
    try:
        Layer(name=name, kind=Layer.Kind.PROPOSAL).clean_fields(exclude=["dataset"])
    except ValidationError as error:
        raise ProposalError(" ".join(error.messages)) from error
    if Layer.objects.filter(dataset=dataset, name=name).exists():
        raise ProposalError(_("The layer %(name)s is there already; choose another name.") % {"name": name})


def make_layer(
    run: ProposalRun,
    name: str,
    threshold: float = THRESHOLD,
    remember: Callable[[Layer], None] | None = None,
) -> Layer:
    """Everybody with at least this score, by tracks. `remember` is told in the transaction it appears in."""
    check_name(run.dataset, name)
    frames = list(_frames(run, threshold))
    if not frames:
        raise ProposalError(_("This run has not looked at any frame yet."))
    with unfinished.layer(run.dataset, hidden=False, kind=Layer.Kind.PROPOSAL) as layer:
        rows.add_annotations(layer, frames)
        try:
            with transaction.atomic():
                unfinished.appear(layer, name)
                if remember:
                    remember(layer)
        except IntegrityError as error:
            raise ProposalError(
                _("The layer %(name)s was made by somebody else in the meantime.") % {"name": name}
            ) from error
    return layer


def _frames(run: ProposalRun, threshold: float) -> Iterator[ImportedFrame]:
    people = Proposal.objects.filter(proposal_frame__run=run)
    largest = max(people.order_by().values_list("track", flat=True).distinct(), key=_number, default=0)
    untracked = count(_number(largest) + 1)
    found: dict[int, list[tuple[int, int, float, float]]] = defaultdict(list)
    confirmed = Q(track__isnull=False) if run.frames.count() > 1 else Q()
    taken = people.filter(Q(score__gte=threshold) & (confirmed | Q(score__gte=max(ALONE, threshold))))
    for number, position, height, radius, track in taken.values_list(*COLUMNS):
        person = next(untracked) if track is None else track
        found[number].append((person, position, _nan(height), _nan(radius)))
    for number in run.frames.order_by("frame__number").values_list("frame__number", flat=True):
        columns = np.array(sorted(found[number]), dtype=np.float64).reshape(-1, 4)
        yield ImportedFrame(
            number,
            columns[:, 0].astype(np.int64),
            columns[:, 1].astype(np.int64),
            columns[:, 2],
            columns[:, 3],
            origin=Annotation.Origin.PROPOSED.value,
        )


def _number(track: int | None) -> int:
    return track or 0


def _nan(value: float | None) -> float:
    return float("nan") if value is None else value
