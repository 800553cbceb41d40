"""An export and a release of a stitched layer say what every annotation was made of."""

from __future__ import annotations

import csv
import json
import uuid
from pathlib import Path
from typing import Any

import pytest

from gtm_hit.ops.exports import exporting
from gtm_hit.ops.exports.sources import SOURCES
from gtm_hit.ops.frames import saving
from gtm_hit.ops.jobs.progress import no_progress
from gtm_hit.ops.releases import releasing
from gtm_hit.ops.stitching.running import Asked, stitch_layer
from gtm_hit.ops.stitching.scope import Scope
from tests.stitch_scene import frame_at, two_batches
from tests.work_scene import as_sent, make_layer, row, save

pytestmark = pytest.mark.django_db


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.EXPORTS_ROOT = tmp_path / "exports"
    settings.RELEASES_ROOT = tmp_path / "releases"


def read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def test_a_release_names_layer_person_and_worker_behind_every_annotation(tmp_path: Path) -> None:
    dataset, (first, second) = two_batches()
    layer = stitch_layer(Scope(dataset), Asked(), None, no_progress).stitching.layer
    order = releasing.Order(layer, "Use it.")
    made = releasing.make_release(order, tmp_path / "partial", no_progress)
    folder = releasing.folder_of(made)
    shared = str(frame_at(dataset, 9).number)
    found = [line for line in read(folder / SOURCES) if (line["frame"], line["person"]) == (shared, "1")]
    assert [(line["source_layer"], line["source_person"], line["worker"]) for line in found] == [
        (first.layer.name, "1", first.worker.pseudonym),
        (second.layer.name, "2", second.worker.pseudonym),
    ]
    manifest = json.loads((folder / "manifest.json").read_text())
    assert SOURCES in manifest["files"]
    assert [each["layer"] for each in manifest["parameters"]["sources"]] == [
        first.layer.name,
        second.layer.name,
    ]
    authors = {line["worker"] for line in read(folder / "provenance.csv") if line["frame"] == shared}
    assert authors == {f"{first.worker.pseudonym} {second.worker.pseudonym}"}


def test_a_frame_changed_by_hand_claims_no_sources(tmp_path: Path) -> None:
    dataset, _ = two_batches()
    layer = stitch_layer(Scope(dataset), Asked(), None, no_progress).stitching.layer
    frame = frame_at(dataset, 3)
    state = saving.read_frame(layer, frame)
    saving.save_frame(layer, frame, None, uuid.uuid4(), 1, as_sent(state.annotations[:1]), done=True)
    exporting.export_layer(layer, tmp_path / "out", tmp_path / "partial", no_progress)
    frames = {int(line["frame"]) for line in read(tmp_path / "out" / SOURCES)}
    assert len(frames) == 19 and frame.number not in frames


def test_a_layer_nobody_stitched_has_no_such_file(tmp_path: Path) -> None:
    dataset, _ = two_batches()
    layer = make_layer(dataset)
    save(layer, frame_at(dataset, 0), [row()], done=True)
    exporting.export_layer(layer, tmp_path / "out", tmp_path / "partial", no_progress)
    assert not (tmp_path / "out" / SOURCES).exists()
