"""Bodies stand where the truth says, are as tall as it says, and hide each other as they should."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gtm_hit.demo.people import Cast, moment
from gtm_hit.demo.pose import Arms, pose
from gtm_hit.demo.wardrobe import Hair
from gtm_hit.geometry.camera import Camera
from tests.demo.people_mask import people_mask

FRAME = 6


def project(camera: Camera, point: list[float]) -> tuple[int, int]:
    """Column and row."""
    seen = camera.rotation @ np.array(point) + camera.tvec
    u, v, w = camera.matrix @ seen
    return round(u / w), round(v / w)


def placed(cast: Cast, places: list[tuple[float, float]]) -> Cast:
    """The first people of the cast at these places, and nobody else."""
    walks, people = cast.walks, len(places)
    xy = np.broadcast_to(np.array(places), (len(walks.xy), people, 2))
    by_frame = {name: getattr(walks, name)[:, :people] for name in ("heading", "phase", "present")}
    by_person = {name: getattr(walks, name)[:people] for name in ("speed", "height", "build", "gaze")}
    return replace(cast, walks=replace(walks, xy=xy, **by_frame, **by_person))


def test_the_middle_between_both_feet_is_the_true_place(cast: Cast) -> None:
    for person, mesh in enumerate(moment(cast, FRAME).meshes):
        feet = mesh.vertices[mesh.vertices[:, 2] < 0.3][:, :2] - cast.walks.xy[FRAME, person]
        heading = cast.walks.heading[FRAME, person]
        for axis in ((np.cos(heading), np.sin(heading)), (-np.sin(heading), np.cos(heading))):
            along = feet @ axis
            assert abs(along.max() + along.min()) / 2 < 0.02


@pytest.mark.parametrize("phase", np.linspace(0, 2 * np.pi, 9))
def test_both_ankles_are_as_far_from_the_true_place(phase: float) -> None:
    ankles = pose(phase, 1.2, Arms.SWING, 0.0).legs[:, 2]
    assert abs(ankles[0, 0] + ankles[1, 0]) / 2 < 0.09
    assert abs(ankles[0, 1] + ankles[1, 1]) < 1e-9


@pytest.mark.parametrize("phase", np.linspace(0, 2 * np.pi, 9))
@pytest.mark.parametrize("speed", [0.0, 0.9, 1.5])
def test_legs_keep_their_length_and_knees_bend_forward(phase: float, speed: float) -> None:
    for hip, knee, ankle in pose(phase, speed, Arms.SWING, 0.0).legs:
        assert np.linalg.norm(knee - hip) == pytest.approx(0.425, abs=0.01)
        assert np.linalg.norm(ankle - knee) == pytest.approx(0.405, abs=0.01)
        assert knee[0] >= (hip[0] + ankle[0]) / 2 - 0.01


def test_nobody_sinks_into_the_ground(cast: Cast) -> None:
    for mesh in moment(cast, FRAME).meshes:
        assert -0.03 < mesh.vertices[:, 2].min() < 0.03


def test_people_are_as_tall_as_the_truth_says(cast: Cast) -> None:
    for person, mesh in enumerate(moment(cast, FRAME).meshes):
        hat = 0.05 if cast.looks[person].hair in (Hair.CAP, Hair.BEANIE) else 0.03
        height = cast.walks.height[person]
        assert height - 0.09 < mesh.vertices[:, 2].max() < height + hat


def test_a_person_is_seen_where_the_true_place_projects(cast: Cast, cameras: list[Camera]) -> None:
    camera = cameras[0]
    alone = placed(cast, [(3.0, 6.0)])
    mask = people_mask(camera, alone, moment(alone, FRAME), FRAME) == 0
    rows, columns = np.nonzero(mask)
    column, row = project(camera, [3.0, 6.0, 0.0])
    head = project(camera, [3.0, 6.0, float(alone.walks.height[0])])[1]
    assert abs(rows.max() - row) < 12
    assert abs(rows.min() - head) < 12
    # The shoes: what is seen in the lowest tenth of the body.
    shoes = columns[rows > row - 0.1 * (row - head)]
    assert abs(shoes.mean() - column) < 0.12 * (row - head)


@pytest.mark.parametrize("nearer", [0, 1])
def test_who_stands_nearer_hides_who_stands_farther(cast: Cast, cameras: list[Camera], nearer: int) -> None:
    camera = cameras[0]
    far = np.array([3.0, 8.0])
    near = camera.centre[:2] + 0.85 * (far - camera.centre[:2])
    order = [near, far] if nearer == 0 else [far, near]
    both = placed(cast, [tuple(place) for place in order])
    mask = people_mask(camera, both, moment(both, FRAME), FRAME)
    column, row = project(camera, [*near, 1.1])
    assert mask[row, column] == nearer
    alone = placed(cast, [tuple(far), tuple(far + 3)])
    assert people_mask(camera, alone, moment(alone, FRAME), FRAME)[row, column] == 0


def test_nobody_is_drawn_behind_the_camera(cast: Cast, cameras: list[Camera]) -> None:
    behind = cameras[0].centre[:2] - 5 * cameras[0].rotation[2, :2]
    alone = placed(cast, [tuple(behind)])
    assert (people_mask(cameras[0], alone, moment(alone, FRAME), FRAME) == -1).all()


def test_neighbours_look_different(cast: Cast) -> None:
    colours = [(*look.top_colour, *look.bottom_colour) for look in cast.looks]
    assert len(set(colours)) == len(colours)
