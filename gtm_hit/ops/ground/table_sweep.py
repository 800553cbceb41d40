"""The end of rectangle tables: those that no calibration in place needs."""

from __future__ import annotations

from datetime import datetime, timedelta

from django.conf import settings

from gtm_hit.geometry.table import table_digest
from gtm_hit.models import Dataset

GRACE = timedelta(days=7)  # somebody may go back to a calibration, and jobs that began before it work on


def sweep(now: datetime) -> int:
    """Remove tables older than GRACE that are not needed; how many. Whoever wants one makes it."""
    oldest = now - GRACE
    old = [
        path
        for path in settings.TABLES_ROOT.glob("rectangles-*.bin")
        if path.stat().st_mtime < oldest.timestamp()
    ]
    if not old:
        return 0
    needed = {f"rectangles-{digest}.bin" for digest in _in_place()}
    unneeded = [path for path in old if path.name not in needed]
    for path in unneeded:
        path.unlink(missing_ok=True)  # whoever has it open keeps its bytes
    return len(unneeded)


def _in_place() -> set[str]:
    datasets = Dataset.objects.prefetch_related("cameras")
    return {
        table_digest(cameras, dataset.grid, dataset.cylinder, dataset.rule)
        for dataset in datasets
        if (cameras := dataset.calibrated_cameras())
    }
