"""What a campaign's batches start with, and which faults are planted in it."""

from __future__ import annotations

from collections.abc import Sequence

from django.db.models import QuerySet
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, Layer, PlantedFault, Planting
from gtm_hit.ops.gold.errors import GoldError
from gtm_hit.scoring.faults import ALL_KINDS, Fault, FaultKind

MOST_FAULTS = 20


def settle(
    campaign: Campaign,
    starting_layer: Layer | None,
    share: float,
    faults: int = 2,
    kinds: Sequence[str] = tuple(ALL_KINDS),
    seed: int = 1,
) -> Planting:
    """For assignments taken from now on; who works already keeps what he has."""
    if starting_layer is not None and starting_layer.dataset_id != campaign.dataset_id:
        raise GoldError(_("%(layer)s is a layer of another dataset.") % {"layer": starting_layer.name})
    if not 0 <= share <= 1:
        raise GoldError(_("The share of batches with faults is between 0 and 1."))
    if not 1 <= faults <= MOST_FAULTS:
        raise GoldError(_("Plant 1 to %(most)d faults in a batch.") % {"most": MOST_FAULTS})
    if unknown := sorted(set(kinds) - set(ALL_KINDS)):
        raise GoldError(_("There is no fault of the kind %(kind)s.") % {"kind": unknown[0]})
    if share and not kinds:
        raise GoldError(_("Choose the kinds of faults to plant."))
    chosen = {
        "starting_layer": starting_layer,
        "share": share,
        "faults": faults,
        "kinds": [kind for kind in ALL_KINDS if kind in kinds],
        "seed": seed,
    }
    return Planting.objects.update_or_create(campaign=campaign, defaults=chosen)[0]


def stop(campaign: Campaign) -> None:
    Planting.objects.filter(campaign=campaign).delete()


def starting_layers(campaign: Campaign) -> QuerySet[Layer]:
    """Also proposals: whoever starts with them looks at everybody anyway. Never the work of others."""
    layers = Layer.objects.filter(dataset=campaign.dataset_id).exclude(kind=Layer.Kind.ASSIGNMENT)
    return layers.order_by("name")


def as_fault(row: PlantedFault) -> Fault:
    """The row must have its frame at hand."""
    place = (row.position_from, row.position_to)
    return Fault(FaultKind(row.kind), row.frame.number, row.person, row.other, *place)
