"""What an address below a campaign may name: one row of each."""

from __future__ import annotations

from decimal import Decimal

from django.utils import timezone

from gtm_hit.models import (
    Appeal,
    Assignment,
    Batch,
    Campaign,
    CampaignLink,
    Comment,
    Dataset,
    Layer,
    MoneyEntry,
    OutboxRow,
    Qualification,
    StitchConflict,
    Stitching,
)
from gtm_hit.ops.campaigns import links
from gtm_hit.ops.work import assignments
from tests.work_scene import make_layer, make_worker


def campaign_fills(dataset: Dataset, layer: Layer, secret: Layer) -> dict[str, str]:
    """By the part of an address; to add an example, add a line."""
    campaign = Campaign.objects.create(dataset=dataset, name="walk", state=Campaign.State.OPEN)
    work = submitted(dataset, campaign)
    link = CampaignLink.objects.create(campaign=campaign, kind=CampaignLink.Kind.INVITATION)
    review, conflict = f"review/{work.pk}", conflict_of(campaign, layer).pk
    row, line = outbox_row(campaign, work).pk, money_line(campaign, work).pk
    qualification = Qualification.objects.create(dataset=dataset, name="feet", truth=secret)
    comment = Comment.objects.create(assignment=work, worker=work.worker, text="Which one?")
    Appeal.objects.create(assignment=work, text="They are all there.")
    return {
        "campaigns/<str:name>": f"campaigns/{campaign.name}",
        "hooks/prolific/<slug:slug>/<str:name>": f"hooks/prolific/{dataset.slug}/{campaign.name}",
        "invitation/<str:token>": f"invitation/{links.token(link)}",
        "links/<int:pk>": f"links/{link.pk}",
        "my-work/<int:pk>": f"my-work/{campaign.pk}",
        "workers/<str:worker>": f"workers/{work.worker.pseudonym}",
        "workers/<str:pseudonym>": f"workers/{work.worker.pseudonym}",
        "outbox/<int:pk>": f"outbox/{row}",
        "rows/<int:pk>": f"rows/{row}",
        "files/<slug:what>": "files/bonuses",
        "ledger/<int:pk>": f"ledger/{line}",
        "lines/<int:pk>": f"lines/{line}",
        "pay/<slug:what>": "pay/workers",
        "qualifications/<str:name>": f"qualifications/{qualification.name}",
        "<int:number>/<int:frame>/<int:camera>/<int:x>-<int:y>-<int:size>": "1/0/0/1-1-9",
        "review/<int:pk>": review,
        "reviews/<int:pk>": f"reviews/{work.pk}",
        "comments/<int:comment>": f"comments/{comment.pk}",
        "comments/<int:pk>": f"comments/{comment.pk}",
        "conflicts/<int:pk>": f"conflicts/{conflict}",
    }


def submitted(dataset: Dataset, campaign: Campaign) -> Assignment:
    made = assignments.claim(make_worker(f"in-{dataset.slug}"), dataset)
    Batch.objects.filter(pk=made.batch_id).update(campaign=campaign)
    worker = made.worker
    worker.platform = campaign.platform
    worker.save(update_fields=["platform"])
    Assignment.objects.filter(pk=made.pk).update(
        state=Assignment.State.SUBMITTED, submitted_at=timezone.now()
    )
    return Assignment.objects.select_related("worker").get(pk=made.pk)


def outbox_row(campaign: Campaign, work: Assignment) -> OutboxRow:
    values = {"kind": OutboxRow.Kind.APPROVE, "worker": work.worker, "assignment": work}
    return OutboxRow.objects.create(campaign=campaign, key="one", submission="s1", **values)


def money_line(campaign: Campaign, work: Assignment) -> MoneyEntry:
    return MoneyEntry.objects.create(
        campaign=campaign,
        worker=work.worker,
        kind=MoneyEntry.Kind.BONUS_APPROVED,
        amount=Decimal("1.00"),
        currency=campaign.currency,
        key=f"bonus-{campaign.pk}",
    )


def conflict_of(campaign: Campaign, seen: Layer) -> StitchConflict:
    side = [[seen.pk, seen.annotations.all()[0].person]]
    layer = make_layer(campaign.dataset, "stitched", Layer.Kind.GROUND_TRUTH)
    stitching = Stitching.objects.create(dataset=campaign.dataset, campaign=campaign, layer=layer)
    return StitchConflict.objects.create(
        stitching=stitching,
        kind=StitchConflict.Kind.JOIN,
        key="0" * 64,
        before=side,
        after=side,
        left_at=0,
        came_at=0,
        metres=0.2,
        seconds=0.5,
    )
