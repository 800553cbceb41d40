"""Leases nobody saved anything in: few at once per link, few per day from one address.

Every lease with a save makes room for another, so that a class of two hundred behind one address is never in
the way of itself, and whoever invents workers soon is. Two who ask at one moment may both get the last place.
"""

from __future__ import annotations

from datetime import timedelta

from django.conf import settings
from django.db.models import Exists, OuterRef, Sum
from django.utils import timezone

from gtm_hit.models import Assignment, Dataset, Save, Worker
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.work.digests import digest

REMEMBERED = timedelta(days=1)
# By the worker: what a batch starts with was saved by nobody.
SAVED = Exists(Save.objects.filter(layer_frame__layer=OuterRef("layer"), worker__isnull=False))


class TooManyUnsaved(OperationError):
    """So many batches were taken from this address, or through this link, that nobody began yet."""


def require_room(worker: Worker, dataset: Dataset, address: str) -> None:
    """Raises TooManyUnsaved."""
    if not room_of_address(address):
        raise TooManyUnsaved(f"{dataset}: too many leases without a save from one address")
    if not room_of_link(worker.platform, dataset):
        raise TooManyUnsaved(f"{dataset}: too many leases without a save through one link")


def room_of_address(address: str) -> bool:
    if not address:
        return True
    taken = Assignment.objects.filter(address=kept(address), leased_at__gt=timezone.now() - REMEMBERED)
    begun = taken.filter(SAVED).count()
    waiting = taken.filter(~SAVED).aggregate(times=Sum("takes"))["times"] or 0
    return waiting < settings.UNSAVED_PER_ADDRESS + begun


def room_of_link(platform: str, dataset: Dataset) -> bool:
    running = Assignment.objects.filter(
        state=Assignment.State.LEASED,
        expires_at__gt=timezone.now(),
        worker__platform=platform,
        batch__dataset=dataset,
    )
    return running.filter(~SAVED).count() < settings.UNSAVED_PER_LINK


def kept(address: str) -> str:
    """What a row keeps of an address: enough to count, nothing to read."""
    return digest(address) if address else ""
