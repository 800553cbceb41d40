"""What runs keep of the frames they looked at, and when it goes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from django.core.files.storage import default_storage

from gtm_hit.models import Dataset, ProposalRun
from gtm_hit.ops.proposals import foregrounds, runs
from gtm_hit.ops.proposals.pictures import pictures_of
from gtm_hit.ops.proposals.proposing import propose
from tests.ops.proposals.watcher import Watcher, make_run

MASKS = {"C1": np.full((9, 16), 0.75, np.float32), "C2": np.zeros((9, 16), np.float32)}


@pytest.fixture
def run(dataset: Dataset) -> ProposalRun:
    """That has looked at every frame, and seen the same in each."""
    watcher = Watcher(dataset, {})
    watcher.masks = MASKS
    made = make_run(dataset)
    propose(made, watcher)
    return made


def files(run: int) -> list[Path]:
    return sorted(Path(default_storage.path(foregrounds.FOLDER)).glob(f"{run}/*"))


def digest(dataset: Dataset) -> str:
    first = dataset.frames.order_by("number")[0]
    return pictures_of([first])[first.pk].digest


def test_a_run_keeps_the_foreground_of_every_frame(dataset: Dataset, run: ProposalRun) -> None:
    back = foregrounds.kept(run, digest(dataset))
    assert back.keys() == MASKS.keys() and all((back[name] == MASKS[name]).all() for name in MASKS)
    assert foregrounds.kept(run, "another picture") == {}


def test_what_is_kept_never_changes(dataset: Dataset, run: ProposalRun) -> None:
    before = [(path, path.stat().st_mtime_ns) for path in files(run.pk)]
    foregrounds.keep(run, digest(dataset), {"C1": np.zeros((9, 16), np.float32)})
    assert [(path, path.stat().st_mtime_ns) for path in files(run.pk)] == before and before


def test_where_no_background_is_known_nothing_is_kept(dataset: Dataset) -> None:
    made = make_run(dataset)
    propose(made, Watcher(dataset, {}))
    assert files(made.pk) == [] and foregrounds.kept(made, digest(dataset)) == {}


def test_a_damaged_file_counts_as_none(dataset: Dataset, run: ProposalRun) -> None:
    path = Path(default_storage.path(foregrounds.name_of(run.pk, digest(dataset))))
    path.write_bytes(path.read_bytes()[:30])
    assert foregrounds.kept(run, digest(dataset)) == {}


def test_files_go_with_their_run(
    dataset: Dataset, run: ProposalRun, django_capture_on_commit_callbacks: object
) -> None:
    pk, other = run.pk, make_run(dataset, asked="again")
    foregrounds.keep(other, "pictures", MASKS)
    with django_capture_on_commit_callbacks(execute=True):  # type: ignore[operator]
        runs.remove(run)
    assert files(pk) == [] and len(files(other.pk)) == 1


def test_what_a_removed_dataset_left_is_swept(dataset: Dataset, run: ProposalRun) -> None:
    pk = run.pk
    assert foregrounds.sweep() == 0 and files(pk)
    ProposalRun.objects.filter(pk=pk).delete()
    assert foregrounds.sweep() == 1
    assert files(pk) == [] and foregrounds.sweep() == 0
