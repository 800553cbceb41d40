"""Putting work right oneself: a copy of the layer under the reviewer's name, accepted in its place."""

from __future__ import annotations

import uuid

from django.contrib.auth.models import User
from django.db import transaction
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Frame, Layer, Mend
from gtm_hit.ops.frames import saving
from gtm_hit.ops.review.actors import require_reviewer
from gtm_hit.ops.review.refusals import WrongState


def mend(assignment: Assignment, by: User) -> Mend:
    """The reviewer's copy, made when he asks for the first time. Raises ReviewRefused."""
    require_reviewer(assignment, by)
    with transaction.atomic():
        locked = Assignment.objects.select_for_update(no_key=True).get(pk=assignment.pk)
        if locked.state != Assignment.State.SUBMITTED:
            raise WrongState(_("Only work that waits for its review can be put right."))
        made = Mend.objects.select_related("layer", "user").filter(assignment=locked).first()
        if made is None:
            return Mend.objects.create(assignment=locked, layer=copied(assignment, by), user=by)
        if made.user_id != by.pk:
            name = made.user.get_username()
            raise WrongState(_("%(name)s puts this batch right already.") % {"name": name})
        return made


def copied(assignment: Assignment, by: User) -> Layer:
    """Every save of it is the reviewer's; the numbers of people stay."""
    name = f"mended-{assignment.pk}-{assignment.layer.name}"[:120]
    layer = Layer.objects.create(
        dataset_id=assignment.batch.dataset_id,
        name=name,
        kind=Layer.Kind.STAFF,
        last_person=assignment.layer.last_person,
    )
    frames = list(Frame.objects.filter(batches=assignment.batch_id).order_by("number"))
    for frame, state in zip(frames, saving.read_frames(assignment.layer, frames), strict=True):
        rows = [row.as_dict() for row in state.annotations]
        saving.save_frame(layer, frame, by, uuid.uuid4(), 0, rows, done=state.done, nobody=state.nobody)
    return layer


def layer_that_counts(assignment: Assignment) -> int:
    """Its id: the mended one's, where that was accepted. Select `mend` with the rows to ask no more."""
    found: Mend | None = getattr(assignment, "mend", None)
    return found.layer_id if found and found.accepted_at else assignment.layer_id
