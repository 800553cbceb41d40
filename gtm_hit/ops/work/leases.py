"""How long a batch is held, and who may change its layer meanwhile."""

from __future__ import annotations

from datetime import datetime, timedelta

from django.conf import settings
from django.utils import timezone

from gtm_hit.models import Assignment, Campaign, Layer, Worker
from gtm_hit.ops.work.readiness import ReadOnly, read_only_reason


def lease_end(campaign: Campaign | None) -> datetime:
    return timezone.now() + timedelta(minutes=lease_minutes(campaign))


def first_lease_end(campaign: Campaign | None) -> datetime:
    """Until something is saved; then `extend` gives the whole time."""
    minutes = min(settings.FIRST_SAVE_MINUTES, lease_minutes(campaign))
    return timezone.now() + timedelta(minutes=minutes)


def lease_minutes(campaign: Campaign | None) -> int:
    return campaign.lease_minutes if campaign else settings.LEASE_MINUTES


def locked_for_layer(layer: Layer) -> Assignment | None:
    if layer.kind != Layer.Kind.ASSIGNMENT:
        return None
    rows = Assignment.objects.select_related("batch__campaign")
    return rows.select_for_update(no_key=True, of=("self",)).filter(layer=layer).first()


def require_editable(layer: Layer, assignment: Assignment | None, worker: Worker | None) -> None:
    """A worker's layer is changed by that worker only, and only while he holds the batch."""
    if layer.kind != Layer.Kind.ASSIGNMENT and worker is None:
        return
    if assignment is None or worker is None or assignment.worker_id != worker.pk:
        raise ReadOnly("not_author")
    if reason := read_only_reason(assignment):
        raise ReadOnly(reason)


def extend(assignment: Assignment) -> None:
    """Activity keeps a lease alive."""
    end = lease_end(assignment.batch.campaign)
    Assignment.objects.filter(pk=assignment.pk, state=Assignment.State.LEASED).update(expires_at=end)
