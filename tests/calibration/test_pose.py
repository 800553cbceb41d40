from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gtm_hit.calibration.ground_points import GroundPoint
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.pose import Pair, PoseError, Trouble, solve_pose
from tests.calibration.clicked import GRID, LENS, clicks, moved, standing, swapped

CAMERA = standing()
PAIRS = clicks(CAMERA, noise=0.7)


def texts(pairs: list[Pair]) -> list[str]:
    return [finding.text for finding in solve_pose(LENS, pairs).findings]


def test_exact_clicks_give_the_exact_pose() -> None:
    found = solve_pose(LENS, clicks(CAMERA))
    assert np.abs(found.centre - CAMERA.centre).max() < 1e-6
    assert np.abs(found.rvec - CAMERA.rvec).max() < 1e-7
    assert found.rms < 1e-4 and found.findings == ()


def test_points_off_the_ground_are_used_as_well() -> None:
    posts = [replace(point, name=point.name + "top", z=1.5) for point in GRID[::3]]
    found = solve_pose(LENS, clicks(CAMERA, [*GRID, *posts]))
    assert np.abs(found.centre - CAMERA.centre).max() < 1e-6


def test_the_centre_lies_within_three_of_its_own_sigma() -> None:
    for seed in range(10):
        found = solve_pose(LENS, clicks(CAMERA, noise=1.0, seed=seed))
        assert (np.abs(found.centre - CAMERA.centre) < 4 * found.centre_sigma).all()
        assert 0.001 < found.centre_spread < 0.1


def test_a_miss_is_told_in_pixels_and_in_centimetres_on_the_ground() -> None:
    pairs = clicks(CAMERA)
    x, y = pairs[12].pixel
    found = solve_pose(LENS, [*pairs[:12], replace(pairs[12], pixel=(x + 2.0, y)), *pairs[13:]])
    miss = found.residuals[12]
    assert 1.5 < miss.px < 2.1
    distance = float(np.linalg.norm(np.array(pairs[12].point) - CAMERA.centre))
    assert miss.cm == pytest.approx(100 * miss.px * distance / 1700, rel=0.2)


@pytest.mark.parametrize(("first", "second"), [(0, 1), (3, 10), (7, 20)])
def test_two_swapped_pairs_are_named_and_left_out(first: int, second: int) -> None:
    found = solve_pose(LENS, swapped(PAIRS, first, second))
    names = (PAIRS[first].name, PAIRS[second].name)
    assert [each.text for each in found.findings] == [f"Pairs {names[0]} and {names[1]} look swapped."]
    assert set(found.outliers) == set(names)
    assert np.linalg.norm(found.centre - CAMERA.centre) < 0.1


@pytest.mark.parametrize(("by", "axis"), [((1.0, 0.0, 0.0), "X"), ((0.0, -1.0, 0.0), "Y")])
def test_a_coordinate_typed_wrong_is_named_with_the_metres(by: tuple[float, float, float], axis: str) -> None:
    assert texts(moved(PAIRS, 12, by)) == [f"{axis} of point {PAIRS[12].name} looks wrong by 1.00 m."]


def test_both_are_named_when_there_are_both() -> None:
    told = texts(moved(swapped(PAIRS, 1, 15), 8, (0.0, 1.0, 0.0)))
    assert told == [
        f"Pairs {PAIRS[1].name} and {PAIRS[15].name} look swapped.",
        f"Y of point {PAIRS[8].name} looks wrong by 1.00 m.",
    ]


def test_one_point_in_centimetres_among_metres_is_named() -> None:
    x, y, z = PAIRS[6].point
    spoilt = [*PAIRS[:6], replace(PAIRS[6], point=(100 * x, 100 * y, 100 * z)), *PAIRS[7:]]
    assert texts(spoilt) == [f"Point {PAIRS[6].name} looks like centimetres, unlike the others."]


def test_a_click_on_another_point_is_named() -> None:
    spoilt = [*PAIRS[:6], replace(PAIRS[6], pixel=PAIRS[18].pixel), *PAIRS[7:]]
    assert texts(spoilt) == [
        f"The click of pair {PAIRS[6].name} lies where point {PAIRS[18].name} is expected."
    ]


def test_a_click_beside_everything_is_told_to_be_made_again() -> None:
    x, y = PAIRS[6].pixel
    (told,) = texts([*PAIRS[:6], replace(PAIRS[6], pixel=(x + 9.0, y - 9.0)), *PAIRS[7:]])
    assert told.startswith(f"Pair {PAIRS[6].name} contradicts the others (12 px off)")


def test_all_points_in_centimetres_look_like_centimetres() -> None:
    scaled = [replace(pair, point=tuple(100 * each for each in pair.point)) for pair in PAIRS]
    (told,) = texts(scaled)
    assert told.startswith("This looks like centimetres: the camera would stand 399 m above the ground")


def test_metres_read_as_centimetres_are_told_too() -> None:
    scaled = [replace(pair, point=tuple(each / 100 for each in pair.point)) for pair in PAIRS]
    assert texts(scaled)[0].startswith("This looks like metres read as centimetres")


def test_fewer_than_eight_pairs_are_a_warning() -> None:
    found = solve_pose(LENS, [PAIRS[0], PAIRS[4], PAIRS[12], PAIRS[20], PAIRS[24]])
    assert Trouble.FEW in {each.trouble for each in found.findings}


def test_clicks_in_a_corner_of_the_picture_are_a_warning() -> None:
    near = [GroundPoint(f"{x}{y}", 0.1 * x, 8 + 0.3 * y) for x in range(4) for y in range(4)]
    found = solve_pose(LENS, clicks(CAMERA, near))
    assert Trouble.HULL in {each.trouble for each in found.findings}


def test_the_wrong_lens_is_suspected() -> None:
    other = Lens(1920, 1080, LENS.matrix * [[1.1], [1.1], [1]], np.array([0.4, 0.0, 0.0, 0.0, 0.0]))
    found = solve_pose(other, PAIRS)
    assert Trouble.LENS in {each.trouble for each in found.findings}


def test_a_small_distant_board_has_two_poses_and_says_so() -> None:
    board = [GroundPoint(f"{x}{y}", 0.05 * x, 14 + 0.05 * y) for x in range(3) for y in range(3)]
    found = solve_pose(LENS, clicks(CAMERA, board, noise=0.4))
    assert Trouble.TWO_POSES in {each.trouble for each in found.findings}


def test_a_click_beyond_the_fold_of_the_lens_is_left_out_and_told() -> None:
    folding = Lens(1920, 1080, LENS.matrix, np.array([-0.9, 0.0, 0.0, 0.0, 0.0]))
    camera = standing(folding)
    good = clicks(camera, lens=folding)
    found = solve_pose(folding, [*good, Pair("corner", (9.0, 3.0, 0.0), (1919.0, 1079.0))])
    assert found.outliers == ("corner",)
    assert [each.names for each in found.findings] == [("corner",)]
    assert np.abs(found.centre - camera.centre).max() < 1e-4


@pytest.mark.parametrize("count", [0, 1, 3])
def test_fewer_than_four_pairs_are_refused(count: int) -> None:
    with pytest.raises(PoseError, match=f"at least 4 pairs; there are {count}"):
        solve_pose(LENS, PAIRS[:count])


def test_points_on_one_line_are_refused() -> None:
    line = [pair for pair in PAIRS if pair.point[0] == PAIRS[0].point[0]]
    assert len(line) >= 4
    with pytest.raises(PoseError, match="on one line"):
        solve_pose(LENS, line)


def test_a_camera_under_the_ground_is_refused_and_the_axes_suspected() -> None:
    turned = [replace(pair, point=(pair.point[1], pair.point[0], pair.point[2])) for pair in PAIRS]
    with pytest.raises(PoseError, match="under the ground; X and Y look interchanged"):
        solve_pose(LENS, turned)


def test_clicks_without_sense_are_refused_whatever_opencv_says() -> None:
    rng = np.random.default_rng(3)
    nonsense = [replace(pair, pixel=tuple(rng.uniform((0, 0), (1920, 1080)))) for pair in PAIRS]
    with pytest.raises(PoseError):
        solve_pose(LENS, nonsense)


@pytest.mark.parametrize("wrong", [float("nan"), float("inf")])
def test_what_is_no_finite_number_is_refused_by_name(wrong: float) -> None:
    with pytest.raises(PoseError, match=f"pair {PAIRS[2].name} holds"):
        solve_pose(LENS, [*PAIRS[:2], replace(PAIRS[2], pixel=(wrong, 4.0)), *PAIRS[3:]])


def test_a_name_or_a_place_given_twice_is_refused() -> None:
    with pytest.raises(PoseError, match="clicked twice"):
        solve_pose(LENS, [*PAIRS, PAIRS[0]])
    with pytest.raises(PoseError, match="same coordinates"):
        solve_pose(LENS, [*PAIRS, replace(PAIRS[0], name="again")])


def test_the_same_pairs_give_the_same_bytes() -> None:
    spoilt = swapped(PAIRS, 3, 10)
    first, second = solve_pose(LENS, spoilt), solve_pose(LENS, spoilt)
    assert first.rvec.tobytes() == second.rvec.tobytes()
    assert first.tvec.tobytes() == second.tvec.tobytes()
