"""An export is there as a whole, or as it was before."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from gtm_hit.formats.manifest import verify
from gtm_hit.models import Dataset, Job, Layer, LayerFrame
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.jobs import queue
from tests.disk_events import recorded
from tests.ops.exports.scene import MIDDLE, export, save

pytestmark = [pytest.mark.django_db, pytest.mark.usefixtures("exports")]


def test_nothing_is_left_when_it_fails(layer: Layer, tmp_path: Path) -> None:
    def fail(phase: str, done: int, total: int) -> None:
        if (phase, done) == (exporting.FRAMES, total):
            raise OSError("disk full")

    with pytest.raises(OSError):
        export(layer, tmp_path / "out", fail)
    assert [path.name for path in tmp_path.iterdir()] == ["tables"]


def test_a_failure_leaves_the_earlier_export_as_it_was(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    before = (folder / "manifest.json").read_bytes(), (tmp_path / "out.zip").read_bytes()
    save(layer, 5, [(1, MIDDLE, {})])

    def lost() -> None:
        raise queue.JobLost("somebody else has it")

    with pytest.raises(queue.JobLost):
        exporting.export_layer(layer, folder, tmp_path / "partial", lambda *_: None, lost)
    assert before == ((folder / "manifest.json").read_bytes(), (tmp_path / "out.zip").read_bytes())


@pytest.mark.parametrize("name", ["out", "out.zip"])
def test_a_rename_that_fails_leaves_the_earlier_export_as_it_was(
    layer: Layer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    folder = export(layer, tmp_path / "out")
    before = (folder / "manifest.json").read_bytes(), (tmp_path / "out.zip").read_bytes()
    save(layer, 5, [(1, MIDDLE, {})])
    replace = Path.replace

    def failing(path: Path, target: Path) -> Path:
        if target == tmp_path / name and path.name.startswith("content"):
            raise OSError("no space for a longer folder")
        return replace(path, target)

    monkeypatch.setattr(Path, "replace", failing)
    with pytest.raises(OSError):
        exporting.export_layer(layer, folder, tmp_path / "partial", lambda *_: None)
    assert before == ((folder / "manifest.json").read_bytes(), (tmp_path / "out.zip").read_bytes())
    assert not (tmp_path / "partial").exists()


def test_an_export_is_on_the_disk_before_it_gets_its_name(
    layer: Layer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    events = recorded(monkeypatch)
    folder = export(layer, tmp_path / "out")
    named = events.index(("rename", folder))
    synced = {path.name for kind, path in events[:named] if kind == "sync"}
    assert synced >= {path.name for path in folder.rglob("*")}
    assert events[-1] == ("sync", tmp_path)


def test_an_earlier_export_is_replaced_whole(layer: Layer, tmp_path: Path) -> None:
    folder = export(layer, tmp_path / "out")
    LayerFrame.objects.filter(frame__number=10).delete()
    export(layer, folder)
    assert verify(folder) == []
    assert not (folder / "annotations_positions" / "00000010.json").exists()


@pytest.fixture
def three_partials(exports: Path, dataset: Dataset) -> Iterator[dict[str, Path]]:
    running = Job.objects.create(kind=Job.Kind.EXPORT_LAYER, dataset=dataset, state="running", attempts=2)
    names = {
        "alive": f"square-own-{running.pk}.partial-{running.pk}-2",
        "lost": f"square-own-{running.pk}.partial-{running.pk}-1",
        "gone": "square-own-999.partial-999-1",
        "other": "a-folder.partially-mine",
    }
    folders = {key: exports / name for key, name in names.items()}
    for folder in folders.values():
        (folder / "content").mkdir(parents=True)
    yield folders


def test_only_unfinished_work_of_dead_attempts_is_removed(three_partials: dict[str, Path]) -> None:
    exporting.remove_dead_partials()
    there = {key for key, folder in three_partials.items() if folder.exists()}
    assert there == {"alive", "other"}
