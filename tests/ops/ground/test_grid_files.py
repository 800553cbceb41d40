from __future__ import annotations

import os
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from gtm_hit.ops.exports import expiry

pytestmark = pytest.mark.django_db


def test_files_whose_making_was_killed_go_after_a_day(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path
    now = datetime(2026, 5, 1, tzinfo=UTC)
    ages = {".grid-a.gz.1": 2, ".rectangles-b.bin.2": 2, ".grid-c.gz.3": 0, "grid-d.gz": 2}  # days
    for name, days in ages.items():
        (tmp_path / name).touch()
        at = (now - timedelta(days=days)).timestamp()
        os.utime(tmp_path / name, (at, at))
    expiry.expire(now)
    assert sorted(path.name for path in tmp_path.iterdir()) == [".grid-c.gz.3", "grid-d.gz"]
