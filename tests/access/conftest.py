from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from django.db import transaction
from django.test import override_settings

from tests.access.scene import ELSEWHERE, HERE, Place, make_place


@dataclass(frozen=True)
class Places:
    here: Place
    elsewhere: Place


@pytest.fixture(scope="module")
def places(
    django_db_setup: None, django_db_blocker: Any, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Places]:
    """Made once: what a request writes is taken back after it, and all of it at the end."""
    folder = tmp_path_factory.mktemp("access")
    folders = {
        name: folder / name.lower()
        for name in (
            "MEDIA_ROOT",
            "EXPORTS_ROOT",
            "RELEASES_ROOT",
            "TABLES_ROOT",
            "UPLOADS_ROOT",
            "INCOMING_ROOT",
        )
    }
    with django_db_blocker.unblock(), override_settings(**folders), transaction.atomic():
        yield Places(make_place(HERE), make_place(ELSEWHERE))
        transaction.set_rollback(True)
