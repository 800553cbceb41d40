from __future__ import annotations

from typing import Any

from django.conf import settings
from django.core.management.base import BaseCommand
from django.utils import timezone

from gtm_hit.ops.exports import expiry, exporting
from gtm_hit.ops.files import picture_cleanup, sources
from gtm_hit.ops.layers import unfinished
from gtm_hit.ops.proposals import foregrounds


class Command(BaseCommand):
    help = (
        "Remove the files of exports older than EXPORT_KEEP_DAYS, archives nobody imported and rectangle "
        "tables nobody used for a week, unfinished work of killed workers, pictures that failed imports "
        "left, and foregrounds of runs of proposing that are gone. The Celery beat does the same every hour. "
        "Releases always stay."
    )

    def handle(self, *args: Any, **options: Any) -> None:
        exporting.remove_dead_partials()
        sources.remove_leftovers()
        pictures = picture_cleanup.remove_unused_pictures(timezone.now())
        foregrounds.sweep()
        unfinished.remove_abandoned(timezone.now())
        count = expiry.expire(timezone.now())
        days = settings.EXPORT_KEEP_DAYS
        kept = f"exports are kept for {days} days" if days else "exports are kept for ever"
        if pictures:
            self.stdout.write(f"{pictures} unused pictures removed.")
        self.stdout.write(f"{count} expired exports removed; {kept}.")
