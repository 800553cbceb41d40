"""What a campaign will cost, before anybody works: batches × copies × pay."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns.cutting import batch_count


@dataclass(frozen=True)
class Estimate:
    frames: int
    batches: int  # of one copy
    copies: int
    pay: Decimal  # for one batch
    minutes: int  # for one batch
    floor: Decimal

    @property
    def to_hand_out(self) -> int:
        return self.batches * self.copies

    @property
    def cost(self) -> Decimal:
        """When every batch is accepted once and nobody falls below the floor."""
        return self.to_hand_out * self.pay

    @property
    def hours(self) -> float:
        return self.to_hand_out * self.minutes / 60

    @property
    def per_hour(self) -> Decimal:
        """What the expected minutes come to."""
        if not self.minutes:
            return Decimal("0.00")
        return (self.pay * 60 / self.minutes).quantize(Decimal("0.01"))

    @property
    def below_floor(self) -> bool:
        return self.per_hour < self.floor


def estimate(campaign: Campaign) -> Estimate:
    """From the dataset's frames; of a campaign that was opened, from the batches that were cut."""
    frames = campaign.dataset.frames.count()
    batches = batch_count(frames, campaign.batch_size, campaign.overlap)
    if campaign.state != Campaign.State.DRAFT:
        batches = campaign.batches.filter(copy=1).count()
    return Estimate(
        frames,
        batches,
        campaign.copies,
        campaign.pay_per_batch,
        campaign.expected_minutes,
        campaign.hourly_floor,
    )
