"""Work that its worker gave up at the platform goes back to the pool; what he saved stays his."""

from __future__ import annotations

from django.utils import timezone

from gtm_hit.models import Assignment, Campaign

GIVEN_UP = [Assignment.State.LEASED, Assignment.State.RETURNED]


def of_submission(campaign: Campaign, submission: str) -> int:
    """Batches under way for it; what is handed in or decided is left alone."""
    held = Assignment.objects.filter(batch__campaign=campaign, submission=submission, state__in=GIVEN_UP)
    return held.update(state=Assignment.State.EXPIRED, expires_at=timezone.now())
