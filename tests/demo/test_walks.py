from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.demo.people import Cast
from gtm_hit.demo.scene import Scene, SceneError, read_scene
from gtm_hit.demo.walks import Walks, make_walks
from gtm_hit.geometry.camera import Camera

SCENE = read_scene()
SECONDS = SCENE.number_step / SCENE.numbers_per_second


def walks_of(seed: int, frames: int = 20) -> Walks:
    scene = replace(SCENE, seed=seed, frame_count=frames)
    return make_walks(scene, scene.rng(1))


def nearest_distance(walks: Walks) -> float:
    apart = np.linalg.norm(walks.xy[:, :, None] - walks.xy[:, None], axis=-1)
    return float((apart + np.eye(walks.people) * 100).min())


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**31))
def test_every_seed_makes_a_crowd_that_keeps_apart_and_stays_of_size(seed: int) -> None:
    walks = walks_of(seed)
    assert nearest_distance(walks) > 0.45
    present = walks.present.sum(axis=1)
    assert present.min() >= 15
    assert present.max() <= 25
    assert walks.height.min() >= 1.5
    assert walks.height.max() <= 1.95


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**31))
def test_people_walk_at_walking_speed_or_stand_still(seed: int) -> None:
    walks = walks_of(seed)
    speed = np.linalg.norm(np.diff(walks.xy, axis=0), axis=2) / SECONDS
    walking = walks.speed > 0
    assert speed[:, walking].min() > 0.8
    assert speed[:, walking].max() < 1.6
    assert speed[:, ~walking].max() == 0


def test_people_face_the_way_they_walk() -> None:
    walks = walks_of(1)
    steps = np.diff(walks.xy, axis=0)[:, walks.speed > 0]
    headings = walks.heading[:-1, walks.speed > 0]
    ahead = np.stack((np.cos(headings), np.sin(headings)), axis=-1)
    assert (np.sum(ahead * steps, axis=-1) > 0.85 * np.linalg.norm(steps, axis=-1)).all()


def test_paths_are_smooth() -> None:
    walks = walks_of(2)
    assert np.abs(np.diff(walks.heading, axis=0)).max() < np.radians(20)


def test_some_walk_in_pairs() -> None:
    walks = walks_of(3)
    apart = np.linalg.norm(walks.xy[:, :, None] - walks.xy[:, None], axis=-1)
    together = (apart < 0.75).all(axis=0) & ~np.eye(walks.people, dtype=bool) & (walks.speed > 0)
    assert together.sum() == 2 * SCENE.crowd.pairs


def test_some_enter_or_leave_the_grid() -> None:
    walks = walks_of(4)
    changing = walks.present.any(axis=0) & ~walks.present.all(axis=0)
    assert changing.sum() >= SCENE.crowd.crossing - 1


def test_present_means_having_a_position() -> None:
    walks = walks_of(5)
    positions = SCENE.grid.position(walks.xy.reshape(-1, 2)).reshape(walks.present.shape)
    assert (positions[walks.present] >= 0).all()
    outside = ~walks.present & (positions >= 0)
    assert not outside.any()


def test_nobody_comes_close_to_a_camera_post() -> None:
    walks = walks_of(6)
    for x, y, radius in SCENE.crowd.keep_clear:
        assert np.hypot(walks.xy[..., 0] - x, walks.xy[..., 1] - y).min() >= radius


def test_most_people_are_seen_by_three_cameras(cast: Cast, cameras: list[Camera]) -> None:
    walks = cast.walks
    seen = np.zeros(walks.present.shape, dtype=int)
    for camera in cameras:
        chest = np.concatenate((walks.xy, np.full((*walks.present.shape, 1), 1.0)), axis=-1)
        points = chest @ camera.rotation.T + camera.tvec
        u, v = (points[..., :2] / points[..., 2:] @ camera.matrix[:2, :2].T + camera.matrix[:2, 2]).T
        inside = (u >= 0) & (u < camera.width) & (v >= 0) & (v < camera.height)
        seen += inside.T & (points[..., 2] > 0)
    assert (seen[walks.present] >= 3).mean() > 0.75


def test_the_same_seed_walks_the_same_way() -> None:
    first, again = walks_of(7), walks_of(7)
    assert np.array_equal(first.xy, again.xy)
    assert np.array_equal(first.phase, again.phase)


def test_a_short_scene_is_the_beginning_of_a_longer_one() -> None:
    short, longer = walks_of(8, frames=3), walks_of(8)
    assert np.array_equal(short.xy, longer.xy[:3])


def test_people_of_a_long_scene_keep_walking_and_keep_apart() -> None:
    walks = walks_of(8, frames=80)
    assert nearest_distance(walks) > 0.45
    assert walks.present.sum(axis=1).min() >= 15
    assert (np.linalg.norm(np.diff(walks.xy, axis=0), axis=2)[:, walks.speed > 0] > 0.1).all()


def test_a_crowd_that_does_not_fit_is_refused(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gtm_hit.demo.walks.ATTEMPTS", 100)
    crowded = replace(scene, crowd=replace(scene.crowd, walkers=2000))
    with pytest.raises(SceneError, match="no room for"):
        make_walks(crowded, crowded.rng(1))
