"""What may still be changed of a campaign once it was opened: one table, enforced and shown."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from django.utils.functional import Promise
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy

from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns.errors import CampaignError

Check = Callable[[Any, Any], bool]


@dataclass(frozen=True)
class Rule:
    """How a field may change while workers are at it."""

    text: str | Promise
    allows: Check

    @property
    def fixed(self) -> bool:
        return self.allows is never


def never(before: Any, after: Any) -> bool:
    return False


def always(before: Any, after: Any) -> bool:
    return True


def rises(before: Any, after: Any) -> bool:
    return after >= before


ADDRESSES = Rule(gettext_lazy("fixed: it stands in addresses and in names of layers"), never)
CUT = Rule(gettext_lazy("fixed: batches are cut"), never)
IDENTITY = Rule(gettext_lazy("fixed: workers are known by their platform's ids"), never)
BOOKS = Rule(gettext_lazy("fixed: the books are kept in it"), never)
COPIES = Rule(gettext_lazy("may grow; copies that are there stay"), rises)
MONEY = Rule(gettext_lazy("may rise; nobody gets less than was promised"), rises)
FREE = Rule(gettext_lazy("may change; counts from the next batch on"), always)
WORDS = Rule(gettext_lazy("may change"), always)

WHILE_OPEN: Mapping[str, Rule] = {
    "name": ADDRESSES,
    "title": WORDS,
    "instructions": WORDS,
    "platform": IDENTITY,
    "platform_settings": WORDS,
    "entry": FREE,
    "batch_size": CUT,
    "overlap": CUT,
    "copies": COPIES,
    "lease_minutes": FREE,
    "batches_per_worker": FREE,
    "batches_at_once": FREE,
    "expected_minutes": WORDS,
    "currency": BOOKS,
    "pay_per_batch": MONEY,
    "hourly_floor": MONEY,
    "review_share": FREE,
    "newcomer_batches": FREE,
}
FIELDS = tuple(WHILE_OPEN)


def rule_of(campaign: Campaign, field: str) -> Rule:
    """What holds for the field now."""
    if campaign.state == Campaign.State.DRAFT:
        return Rule(_("may change until the campaign opens"), always)
    if campaign.state == Campaign.State.CLOSED:
        return Rule(_("fixed: the campaign is closed"), never)
    return WHILE_OPEN[field]


def require_allowed(campaign: Campaign, field: str, after: Any) -> None:
    """Raises CampaignError for a change that is not allowed in the campaign's state."""
    before = getattr(campaign, field)
    if before == after:
        return
    rule = rule_of(campaign, field)
    if not rule.allows(before, after):
        named = {"field": label(field), "rule": rule.text}
        raise CampaignError(_("“%(field)s” cannot be changed like this: %(rule)s.") % named, field)


def label(field: str) -> str:
    return str(LABELS[field])


LABELS: Mapping[str, str | Promise] = {
    "name": gettext_lazy("name in addresses"),
    "title": gettext_lazy("title"),
    "instructions": gettext_lazy("instructions"),
    "platform": gettext_lazy("platform"),
    "platform_settings": gettext_lazy("settings of the platform"),
    "entry": gettext_lazy("who may come in"),
    "batch_size": gettext_lazy("frames per batch"),
    "overlap": gettext_lazy("frames shared by neighbours"),
    "copies": gettext_lazy("copies of each batch"),
    "lease_minutes": gettext_lazy("minutes without a save until a batch goes back"),
    "batches_per_worker": gettext_lazy("batches per worker"),
    "batches_at_once": gettext_lazy("batches at once"),
    "expected_minutes": gettext_lazy("expected minutes per batch"),
    "currency": gettext_lazy("currency"),
    "pay_per_batch": gettext_lazy("pay per batch"),
    "hourly_floor": gettext_lazy("least pay per hour"),
    "review_share": gettext_lazy("share reviewed of a trusted worker"),
    "newcomer_batches": gettext_lazy("batches reviewed in full of a newcomer"),
}
