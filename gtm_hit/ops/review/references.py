"""What an assignment can be laid beside: another copy, the truth, neighbours, any layer with its frames."""

from __future__ import annotations

from dataclasses import dataclass

from django.db.models import Exists, OuterRef, Q
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Layer, LayerFrame, Mend

MOST = 50
Kind = Layer.Kind
WORTH_READING = [Assignment.State.SUBMITTED, Assignment.State.ACCEPTED]


@dataclass(frozen=True)
class Reference:
    layer: Layer
    about: str  # what it is, in words
    rank: int  # the smaller, the sooner it is taken


def references(assignment: Assignment) -> list[Reference]:
    """Layers with at least one frame of the batch, the most telling first; three queries."""
    batch = assignment.batch
    saved = LayerFrame.objects.filter(
        layer=OuterRef("pk"), revision__gte=1, frame__in=batch.frames.values("pk")
    )
    found = Layer.objects.filter(Exists(saved), dataset=batch.dataset_id).exclude(pk=assignment.layer_id)
    found = found.filter(
        ~Q(kind=Kind.ASSIGNMENT) | Q(assignment__state__in=WORTH_READING),
    ).select_related("assignment__batch", "assignment__worker", "dataset")
    mends = dict(Mend.objects.filter(layer__in=found).values_list("layer_id", "assignment_id"))
    told = [told_of(layer, assignment, mends) for layer in found.order_by("-pk")[: 4 * MOST]]
    return sorted(told, key=lambda one: (one.rank, one.layer.name))[:MOST]


def told_of(layer: Layer, assignment: Assignment, mends: dict[int, int]) -> Reference:
    if layer.pk in mends:
        own = mends[layer.pk] == assignment.pk
        return Reference(layer, _("corrected copy") if own else _("another corrected copy"), 0 if own else 4)
    if layer.kind == Kind.GROUND_TRUTH:
        return Reference(layer, _("ground truth"), 1)
    if layer.kind == Kind.ASSIGNMENT:
        return of_worker(layer, assignment)
    if layer.hidden:
        return Reference(layer, _("known truth"), 2)
    if layer.kind == Kind.PROPOSAL:
        return Reference(layer, _("carried over from: proposed by a program"), 5)
    return Reference(layer, layer.get_kind_display(), 6)


def of_worker(layer: Layer, assignment: Assignment) -> Reference:
    other = layer.assignment
    worker = other.worker.pseudonym
    if other.batch.number == assignment.batch.number:
        return Reference(layer, _("the same batch by %(worker)s") % {"worker": worker}, 3)
    return Reference(layer, _("carried over from: neighbouring batch by %(worker)s") % {"worker": worker}, 4)


def chosen(assignment: Assignment, name: str | None) -> tuple[list[Reference], Reference | None]:
    """What there is, and the one with this name; without a name the most telling one, if there is any."""
    found = references(assignment)
    if name is None:
        return found, next(iter(found), None)
    return found, next((one for one in found if one.layer.name == name), None)
