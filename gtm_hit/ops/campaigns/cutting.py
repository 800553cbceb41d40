"""A campaign's batches: runs of frames that share some with their neighbours, several copies of each."""

from __future__ import annotations

from collections.abc import Sequence

from django.db import transaction
from django.utils.translation import gettext as _

from gtm_hit.models import Batch, Campaign, Dataset, Frame
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work import batches


def runs(frames: Sequence[int], size: int, overlap: int) -> list[list[int]]:
    """Runs of at most `size` frames, each beginning `overlap` before the end of the one before.

    The last run is as long as what is left; it always has a frame of its own.
    """
    found = [list(frames[:size])] if frames else []
    start = size - overlap
    while start + overlap < len(frames):
        found.append(list(frames[start : start + size]))
        start += size - overlap
    return found


def batch_count(frames: int, size: int, overlap: int) -> int:
    """How many runs there are of so many frames, without making them."""
    if frames <= 0:
        return 0
    return 1 + max(0, -(-(frames - size) // (size - overlap)))


def cut(campaign: Campaign) -> int:
    """Cut the dataset once and add missing copies; how many batches were added. Again: nothing new."""
    with transaction.atomic():
        Dataset.objects.select_for_update(no_key=True).get(pk=campaign.dataset_id)
        there: dict[int, set[int]] = {}
        for number, copy in campaign.batches.values_list("number", "copy"):
            there.setdefault(number, set()).add(copy)
        frames_of = frames_by_number(campaign) if there else fresh(campaign)
        missing = [
            Batch(dataset_id=campaign.dataset_id, campaign=campaign, number=number, copy=copy)
            for number in sorted(frames_of)
            for copy in range(1, campaign.copies + 1)
            if copy not in there.get(number, set())
        ]
        return batches.write(missing, frames_of)


def fresh(campaign: Campaign) -> dict[int, list[int]]:
    frames = list(
        Frame.objects.filter(dataset=campaign.dataset_id).order_by("number").values_list("pk", flat=True)
    )
    if not frames:
        raise CampaignError(_("The dataset has no frames yet."))
    return dict(enumerate(runs(frames, campaign.batch_size, campaign.overlap), start=1))


def frames_by_number(campaign: Campaign) -> dict[int, list[int]]:
    """Of the batches there are: a number means the same frames in every copy."""
    links = Batch.frames.through.objects.filter(batch__campaign=campaign, batch__copy=1)
    found: dict[int, list[int]] = {}
    for number, frame in links.values_list("batch__number", "frame_id"):
        found.setdefault(number, []).append(frame)
    return found
