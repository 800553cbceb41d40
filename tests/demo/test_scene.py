from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gtm_hit.demo.scene import FIXTURE, Scene, SceneError, read_scene


def written(folder: Path, **changes: Any) -> Path:
    path = folder / "scene.json"
    path.write_text(json.dumps({**json.loads(FIXTURE.read_text(encoding="utf-8")), **changes}))
    return path


def test_frames_are_numbered_like_wildtrack(scene: Scene) -> None:
    assert scene.frame_numbers == list(range(0, 100, 5))


def test_the_grid_is_wildtracks(scene: Scene) -> None:
    assert (scene.grid.columns, scene.grid.rows, scene.grid.step) == (480, 1440, 0.025)
    assert (scene.grid.origin_x, scene.grid.origin_y) == (-3.0, -9.0)


def test_the_sun_is_a_unit_vector_above_the_horizon(scene: Scene) -> None:
    assert np.linalg.norm(scene.sun) == pytest.approx(1)
    assert scene.sun[2] > 0


def test_randomness_of_two_topics_differs_and_repeats(scene: Scene) -> None:
    first, again, other = scene.rng(1).random(), scene.rng(1).random(), scene.rng(2).random()
    assert first == again
    assert first != other


def test_a_missing_entry_is_named(tmp_path: Path) -> None:
    path = written(tmp_path)
    data = json.loads(path.read_text())
    del data["steps"]
    path.write_text(json.dumps(data))
    with pytest.raises(SceneError, match="entry 'steps' is missing"):
        read_scene(path)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        (
            {"frames": {"count": 0, "number_step": 5, "numbers_per_second": 10}},
            "frames.count must be at least 1",
        ),
        (
            {"sun": {"towards_x": 1, "towards_y": 0, "elevation_degrees": 2}},
            "elevation_degrees must be within",
        ),
        ({"steps": {"x": 9.3}}, "missing"),
        ({"steps": {"height": 1}}, "height"),
    ],
)
def test_an_impossible_description_is_refused(tmp_path: Path, changes: dict[str, Any], reason: str) -> None:
    with pytest.raises(SceneError, match=reason):
        read_scene(written(tmp_path, **changes))


def test_more_people_crossing_than_walking_is_refused(tmp_path: Path) -> None:
    crowd = json.loads(FIXTURE.read_text(encoding="utf-8"))["crowd"]
    with pytest.raises(SceneError, match="crossing must not exceed"):
        read_scene(written(tmp_path, crowd={**crowd, "crossing": crowd["walkers"] + 1}))
