"""The demo scene at a sixth of its size: everything but the number of pixels is real."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.demo import walks
from gtm_hit.demo.render import truth
from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras, save_cameras
from gtm_hit.models import Annotation, Batch, Dataset, Frame, Image, Layer
from gtm_hit.ops.datasets import demo

pytestmark = pytest.mark.django_db
FRAMES = 3


@pytest.fixture(autouse=True)
def small_cameras(settings: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    settings.MEDIA_ROOT = tmp_path / "media"
    settings.TABLES_ROOT = tmp_path / "tables"
    smaller = np.diag([1 / 6, 1 / 6, 1.0])
    cameras = [
        replace(camera, width=320, height=180, matrix=smaller @ camera.matrix)
        for camera in load_cameras(demo.CAMERAS)
    ]
    save_cameras(tmp_path / "cameras.json", cameras)
    monkeypatch.setattr(demo, "CAMERAS", tmp_path / "cameras.json")


def run(**options: Any) -> str:
    out = io.StringIO()
    call_command("makedemo", stdout=out, **options)
    return out.getvalue()


def test_the_scene_its_hidden_truth_and_its_batches_are_made_once() -> None:
    assert f"Demo scene demo made: {FRAMES} frames, 1 batches." in run(frames=FRAMES)
    dataset = Dataset.objects.get(slug="demo")
    assert list(dataset.frames.values_list("number", flat=True)) == [0, 5, 10]
    assert Image.objects.count() == 7 * FRAMES
    assert dataset.seconds_per_frame == 0.5
    layer = Layer.objects.get()
    assert (layer.name, layer.kind, layer.hidden) == ("truth", Layer.Kind.GROUND_TRUTH, True)
    expected = {
        (row.number, row.person, row.position) for row in truth(replace(read_scene(), frame_count=FRAMES))
    }
    assert set(Annotation.objects.values_list("frame__number", "person", "position")) == expected

    assert "Demo scene demo was there already" in run(frames=FRAMES)
    assert (Dataset.objects.count(), Frame.objects.count(), Batch.objects.count()) == (1, FRAMES, 1)


def test_a_demo_scene_that_lost_its_batches_gets_them_again() -> None:
    dataset = Dataset.objects.create(slug="demo", name="Demo")
    Layer.objects.create(dataset=dataset, name="truth", kind=Layer.Kind.GROUND_TRUTH, hidden=True)
    Frame.objects.create(dataset=dataset, number=0)
    assert "was there already: 1 frames, 1 batches." in run()


def test_another_dataset_of_that_name_is_left_alone() -> None:
    Dataset.objects.create(slug="demo", name="Mine")
    with pytest.raises(CommandError, match="is no demo scene"):
        run()


@pytest.mark.parametrize("frames", [0, -1, 10**6])
def test_an_impossible_number_of_frames_is_refused(frames: int) -> None:
    with pytest.raises(CommandError, match="1 to 1000 frames"):
        run(frames=frames)
    assert not Dataset.objects.exists()


def test_a_crowd_that_finds_no_room_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = read_scene()
    closed = replace(scene, crowd=replace(scene.crowd, keep_clear=((3.0, 9.0, 100.0),)))
    monkeypatch.setattr(demo, "read_scene", lambda: closed)
    monkeypatch.setattr(walks, "ATTEMPTS", 20)
    with pytest.raises(CommandError, match=r"20 frames with seed 7: no room .* try another seed"):
        run()
    assert not Dataset.objects.exists()
