from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.demo.loft import Part, ball, box, limb, normals
from gtm_hit.demo.splat import Mesh, draw, far_to_near, nearest_samples
from gtm_hit.geometry.camera import Camera

AXES = np.eye(3)
CAMERA = Camera(
    0,
    "C1",
    640,
    480,
    np.array([[600.0, 0, 320], [0, 600, 240], [0, 0, 1]]),
    np.zeros(3),
    np.zeros(3),
    np.zeros(5),
)


def mesh_of(*points: np.ndarray, grey: float = 0.5) -> Mesh:
    colours = np.full((8, 8, 3), grey, dtype=np.float32)
    parts = tuple(Part(rows, colours) for rows in points)
    vertices = np.concatenate([rows.reshape(-1, 3) for rows in points])
    directions = np.concatenate([normals(rows).reshape(-1, 3) for rows in points])
    return Mesh(parts, vertices, directions, np.ones(vertices.shape, np.float32))


def globe(x: float, y: float, z: float, size: float) -> np.ndarray:
    return ball(np.array([x, y, z]), AXES[0], AXES[1], AXES[2], (size, size, size), 15)


@settings(max_examples=40, deadline=None)
@given(st.floats(0.1, 0.8), st.floats(3.0, 30.0), st.floats(-0.5, 0.5))
def test_a_ball_is_a_disc_without_holes(size: float, away: float, aside: float) -> None:
    sprite = draw(CAMERA, mesh_of(globe(aside, 0, away, size)))
    assert sprite is not None
    radius = 600 * size / away
    rows, columns = np.mgrid[0 : sprite.cover.shape[0], 0 : sprite.cover.shape[1]]
    from_middle = np.hypot(columns + sprite.left - (320 + 600 * aside / away), rows + sprite.top - 240)
    assert (sprite.cover[from_middle < 0.86 * radius - 2] > 0.99).all()
    assert (sprite.cover[from_middle > 1.12 * radius + 2] < 0.01).all()


@pytest.mark.parametrize("power", [2.0, 4.5, 6.0])
def test_boxes_have_no_holes(power: float) -> None:
    crate = box(np.array([0, 0, 6.0]), AXES[0], AXES[2], AXES[1], (0.5, 0.4, 0.7), power)
    sprite = draw(CAMERA, mesh_of(crate))
    assert sprite is not None
    middle = sprite.cover[20:-20, 20:-20]
    assert (middle > 0.99).all()


def test_a_bent_limb_has_no_holes() -> None:
    joints = np.array([[0, -0.8, 4.0], [0.25, 0, 4.0], [0, 0.8, 4.0]])
    width = np.full(21, 0.12)
    tube = limb(joints, np.array([0, 0, -1.0]), np.linspace(0, 2, 21), width, width, 0.3)
    sprite = draw(CAMERA, mesh_of(tube))
    assert sprite is not None
    for row in sprite.cover[10:-10]:
        inside = np.flatnonzero(row > 0.5)
        assert (row[inside[0] + 2 : inside[-1] - 1] > 0.99).all()


def test_the_nearer_part_is_seen() -> None:
    near, far = globe(0, 0, 4, 0.3), globe(0, 0, 6, 0.9)
    colours = [np.full((4, 4, 3), tone, dtype=np.float32) for tone in (1.0, 0.0)]
    mesh = mesh_of(near, far)
    mesh = Mesh(
        tuple(Part(part.points, tone) for part, tone in zip(mesh.parts, colours, strict=True)),
        mesh.vertices, mesh.normals, mesh.light,
    )  # fmt: skip
    sprite = draw(CAMERA, mesh)
    assert sprite is not None
    assert sprite.colour[240 - sprite.top, 320 - sprite.left, 0] == pytest.approx(1)
    assert sprite.colour[240 - sprite.top, 320 - sprite.left + 60, 0] == pytest.approx(0)


@pytest.mark.parametrize("place", [(0, 0, -5), (0, 0, 0.5), (30, 0, 5), (0, -30, 5)])
def test_what_is_behind_too_close_or_beside_is_not_drawn(place: tuple[float, float, float]) -> None:
    assert draw(CAMERA, mesh_of(globe(*place, 0.3))) is None


def test_what_is_half_outside_is_cut_at_the_border() -> None:
    sprite = draw(CAMERA, mesh_of(globe(-2.6, 0, 5, 0.5)))
    assert sprite is not None
    assert sprite.left == 0
    assert sprite.cover[:, 0].max() > 0.99


def test_samples_are_ordered_from_far_to_near() -> None:
    depth = np.array([3.0, 9.0, 1.0, 4.0], dtype=np.float32)
    assert far_to_near(depth).tolist() == [1, 3, 0, 2]


def test_a_sample_covers_the_four_pixels_around_it_unless_it_faces_away() -> None:
    samples = np.array([[2.4, 1.6, 5, 1], [6, 3, 5, -1]], dtype=np.float32)
    winner = nearest_samples(samples, (5, 8))
    assert np.argwhere(winner == 0).tolist() == [[1, 1], [1, 2], [2, 1], [2, 2]]
    assert not (winner == 1).any()
