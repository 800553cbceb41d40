from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck
from hypothesis import settings as hypothesis_settings

from tests.demo_frames import LookedAt, look
from tests.prolific_server import Prolific, prolific_server

REPOSITORY = Path(__file__).resolve().parent.parent

# Properties are about results; how long an example takes depends on what else the machine is doing.
hypothesis_settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
hypothesis_settings.load_profile("untimed")


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Reference data of public datasets, kept beside the repository and never inside it."""
    folder = REPOSITORY.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("reference data not present: ../shared/data")
    return folder


@pytest.fixture(scope="session")
def demo_frames(tmp_path_factory: pytest.TempPathFactory) -> LookedAt:
    """The demo scene's first ten frames and whom the built-in detector finds in them."""
    return look(tmp_path_factory.mktemp("demo"))


@pytest.fixture
def prolific(settings: Any) -> Iterator[Prolific]:
    """A Prolific of the test's own, where ada takes part as s1."""
    with prolific_server() as server:
        settings.PROLIFIC_ADDRESSES = [server.base]
        server.add("s1", "ada")
        yield server
