from __future__ import annotations

from pathlib import Path

import pytest

from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.geometry.table import RectangleTable
from tests.geometry.scenes import PERSON, WILDTRACK_GRID, wildtrack_cameras


@pytest.fixture(scope="session")
def wildtrack_table(tmp_path_factory: pytest.TempPathFactory) -> RectangleTable:
    folder: Path = tmp_path_factory.mktemp("tables")
    return RectangleTable.build(folder, wildtrack_cameras(), WILDTRACK_GRID, PERSON, FootRule.CORNERS)
