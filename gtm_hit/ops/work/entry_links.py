"""The switch of a dataset's general link. Whoever works already goes on; personal links stay open."""

from __future__ import annotations

import secrets

from django.db import transaction
from django.utils import timezone

from gtm_hit.models import Dataset, EntryLink


def state(dataset: Dataset, platform: str) -> EntryLink:
    """A link nobody ever closed has no row."""
    kept = EntryLink.objects.filter(dataset=dataset, platform=platform).first()
    return kept or EntryLink(dataset=dataset, platform=platform)


def close(dataset: Dataset, platform: str) -> None:
    link, _created = EntryLink.objects.get_or_create(dataset=dataset, platform=platform)
    EntryLink.objects.filter(pk=link.pk, closed_at=None).update(closed_at=timezone.now())


def reopen(dataset: Dataset, platform: str) -> None:
    """With a new address: a link that was passed on too far stays dead."""
    with transaction.atomic():
        closed = EntryLink.objects.filter(dataset=dataset, platform=platform, closed_at__isnull=False)
        closed.update(closed_at=None, nonce=secrets.token_hex(8))
