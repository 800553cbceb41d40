"""Which frames of a campaign are gold. Their batches hold them like any others; workers cannot tell."""

from __future__ import annotations

import numpy as np
from django.db import transaction
from django.db.models import QuerySet
from django.utils.translation import gettext as _

from gtm_hit.models import Batch, Campaign, Frame, GoldFrame, Layer, Qualification
from gtm_hit.ops.gold.errors import GoldError
from gtm_hit.ops.gold.truths import frames_known, truths


def choose(campaign: Campaign, truth: Layer, share: float, seed: int = 1) -> int:
    """Make this share of the campaign's frames that the layer knows gold; the number of gold frames then.

    Again with the same seed: the same frames. The choice takes the place of an earlier one by the same layer.
    """
    if truth.dataset_id != campaign.dataset_id or not truths(campaign.dataset).filter(pk=truth.pk).exists():
        raise GoldError(_("%(layer)s is no known truth of this dataset.") % {"layer": truth.name})
    if not 0 <= share <= 1:
        raise GoldError(_("The share of gold frames is between 0 and 1."))
    known = list(candidates(campaign, truth).values_list("pk", flat=True))
    if share and not known:
        raise GoldError(_("%(layer)s has no frame of this campaign.") % {"layer": truth.name})
    wanted = set(sampled(known, share, seed))
    with transaction.atomic():
        before = GoldFrame.objects.filter(campaign=campaign, truth=truth)
        before.exclude(frame__in=wanted).delete()
        rows = [GoldFrame(campaign=campaign, frame_id=pk, truth=truth) for pk in sorted(wanted)]
        GoldFrame.objects.bulk_create(rows, ignore_conflicts=True)
    return GoldFrame.objects.filter(campaign=campaign).count()


def sampled(known: list[int], share: float, seed: int) -> list[int]:
    """A larger share keeps the frames of a smaller one."""
    order = np.random.default_rng(seed).permutation(np.array(known, np.int64))
    return order[: round(share * len(known)) or int(share > 0)].tolist()


def candidates(campaign: Campaign, truth: Layer) -> QuerySet[Frame]:
    """Not those of a qualification: afterwards its workers see the truth of its frames."""
    shown = Qualification.frames.through.objects.filter(qualification__dataset=campaign.dataset_id)
    known = frames_known(truth).exclude(pk__in=shown.values("frame_id"))
    batches = Batch.objects.filter(campaign=campaign)
    if not batches.exists():
        return known
    handed_out = Batch.frames.through.objects.filter(batch__in=batches).values("frame_id")
    return known.filter(pk__in=handed_out)


def remove(campaign: Campaign, truth: Layer | None = None) -> int:
    """The number of frames that are gold no more."""
    gold = GoldFrame.objects.filter(campaign=campaign, **({"truth": truth} if truth else {}))
    return gold.delete()[0]


def gold_frames(campaign: Campaign) -> QuerySet[GoldFrame]:
    found = GoldFrame.objects.filter(campaign=campaign).select_related("frame", "truth")
    return found.order_by("frame__number")
