"""MultiviewX comes in as published and goes out as published: the same people, positions and boxes."""

from __future__ import annotations

import json
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from django.core.management import call_command

pytestmark = pytest.mark.django_db


def people_by_id(file: Path) -> dict[int, dict[str, Any]]:
    return {one["personID"]: one for one in json.loads(file.read_text(encoding="utf-8"))}


def test_the_imported_layer_is_exported_file_for_file(shared_data: Path, tmp_path: Path) -> None:
    published = shared_data / "multiviewx" / "annotations_positions"
    call_command(
        "importdataset", "mvx", str(shared_data / "multiviewx"), preset="multiviewx", stdout=StringIO()
    )

    call_command("exportlayer", "mvx", "imported", str(tmp_path / "out"), stdout=StringIO())

    exported = tmp_path / "out" / "annotations_positions"
    names = sorted(file.name for file in published.glob("*.json"))
    assert sorted(file.name for file in exported.iterdir()) == names
    assert len(names) == 5
    for name in names:
        before, after = people_by_id(published / name), people_by_id(exported / name)
        assert before.keys() == after.keys()
        for person, row in before.items():
            assert {key: after[person][key] for key in row} == row
