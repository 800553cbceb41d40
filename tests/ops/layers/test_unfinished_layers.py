"""An import of annotations writes in short transactions, and its layer appears at once."""

from __future__ import annotations

from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from django.db import connection
from django.utils import timezone

from gtm_hit.models import Annotation, Dataset, Job, Layer, LayerFrame, Save
from gtm_hit.ops.datasets import rows
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.layers import unfinished
from gtm_hit.ops.layers.importing import (
    WRITING,
    AnnotationSource,
    LayerReport,
    import_annotations,
)
from gtm_hit.tasks import OPERATIONS
from tests.archives import made
from tests.ops.square_layer import NUMBERS, content, make_square
from tests.work_scene import make_layer

pytestmark = pytest.mark.django_db(transaction=True)

LINES = "".join(f"{number} 40 30 7\n" for number in NUMBERS)


@pytest.fixture(autouse=True)
def frame_by_frame(settings: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    settings.TABLES_ROOT, settings.UPLOADS_ROOT = tmp_path / "tables", tmp_path / "uploads"
    monkeypatch.setattr(rows, "FRAMES_AT_ONCE", 1)


@pytest.fixture
def dataset() -> Dataset:
    return make_square()


class Stop(Exception):
    pass


def run(dataset: Dataset, folder: Path, while_writing: Any) -> LayerReport:
    def report(phase: str, done: int, total: int) -> None:
        if phase == WRITING:
            while_writing(done)

    (folder / "people.txt").write_text(LINES)
    return import_annotations(dataset, AnnotationSource(folder / "people.txt", "text", "back"), report)


def nothing_is_left() -> bool:
    return not any(
        manager.exists()
        for manager in (Layer.with_unfinished, Annotation.objects, LayerFrame.objects, Save.objects)
    )


def test_progress_is_told_outside_of_transactions(dataset: Dataset, tmp_path: Path) -> None:
    inside: list[bool] = []
    run(dataset, tmp_path, lambda _done: inside.append(connection.in_atomic_block))
    assert inside == [False] * len(NUMBERS)


def test_a_layer_appears_when_all_of_it_is_there(dataset: Dataset, tmp_path: Path) -> None:
    seen: list[tuple[bool, bool, int]] = []

    def look(_done: int) -> None:
        listed = dataset.layers.exists() or Layer.objects.exists()
        seen.append((listed, Layer.with_unfinished.exists(), Annotation.objects.count()))

    report = run(dataset, tmp_path, look)
    assert seen == [(False, True, count) for count in range(len(NUMBERS))]
    assert Layer.objects.get() == report.layer
    assert (report.layer.name, len(content(report.layer))) == ("back", len(NUMBERS))


def test_an_import_that_is_stopped_in_the_middle_leaves_nothing(dataset: Dataset, tmp_path: Path) -> None:
    def stop(done: int) -> None:
        if done == 3:
            raise Stop

    with pytest.raises(Stop):
        run(dataset, tmp_path, stop)
    assert nothing_is_left()


def test_cancel_stops_an_import_that_is_writing(
    dataset: Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(queue, "SECONDS_BETWEEN_REPORTS", 0)
    (tmp_path / "uploads").mkdir()
    made(tmp_path / "uploads" / "people.zip", ("people.txt", LINES.encode()))
    parameters = {
        "source": "uploads/people.zip",
        "format": "text",
        "layer": "back",
        "drop": [],
        "hidden": False,
    }
    job = queue.create(Job.Kind.IMPORT_ANNOTATIONS, dataset, parameters)
    add = rows._add_annotations

    def add_and_cancel(*arguments: Any) -> None:
        add(*arguments)
        queue.cancel(job)

    monkeypatch.setattr(rows, "_add_annotations", add_and_cancel)
    queue.run(job.pk, OPERATIONS)
    assert Job.objects.get().state == Job.State.CANCELLED
    assert nothing_is_left()


def test_a_name_taken_in_the_meantime_is_told_and_leaves_that_layer_alone(
    dataset: Dataset, tmp_path: Path
) -> None:
    def somebody_is_faster(done: int) -> None:
        if done == 2:
            make_layer(dataset, "back")

    with pytest.raises(ImportFailed, match="by somebody else in the meantime"):
        run(dataset, tmp_path, somebody_is_faster)
    assert Layer.with_unfinished.get().name == "back"
    assert not Annotation.objects.exists()


def test_what_a_killed_import_left_goes_after_a_day(dataset: Dataset, tmp_path: Path) -> None:
    killed = Layer.objects.create(dataset=dataset, name="killed", kind=Layer.Kind.IMPORTED, unfinished=True)
    run(dataset, tmp_path, lambda _done: None)
    unfinished.remove_abandoned(timezone.now())
    assert Layer.with_unfinished.filter(pk=killed.pk).exists()
    unfinished.remove_abandoned(timezone.now() + timedelta(days=2))
    assert Layer.with_unfinished.get().name == "back"
