"""The lens out of views: right, with honest numbers, and never a success that is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gtm_hit.calibration.intrinsics import LensError, fold_reach, solve_lens
from gtm_hit.calibration.lens_models import Coefficients, LensModel
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.verdict import Word, judge
from gtm_hit.calibration.views import BoardView
from gtm_hit.demo.boards import Placement, placements
from tests.calibration.board_scene import CHESS, KINDS, LENS, SIZE, exact_view, views


def exact(count: int = 10, noise: float = 0.0) -> list[BoardView]:
    placed = placements(LENS, CHESS, count, seed=4)
    return [exact_view(f"{number:02d}", placement, noise=noise) for number, placement in enumerate(placed)]


@pytest.mark.parametrize("kind", KINDS)
def test_a_rendered_boards_lens_is_found_again(kind: str) -> None:
    found = solve_lens(views(kind), SIZE)
    assert found.rms < 0.06
    for name, true in (("fx", LENS.matrix[0, 0]), ("fy", LENS.matrix[1, 1])):
        assert abs(found.parameters[name] - true) < max(0.001 * true, 3 * found.sigma[name])
    for name, true in (("cx", LENS.matrix[0, 2]), ("cy", LENS.matrix[1, 2])):
        assert abs(found.parameters[name] - true) < max(0.5, 3 * found.sigma[name])


def test_exact_points_give_the_exact_lens() -> None:
    found = solve_lens(exact(), SIZE)
    assert np.allclose(found.lens.matrix, LENS.matrix, atol=0.01)
    assert np.allclose(found.lens.distortion, LENS.distortion, atol=0.002)
    assert found.rms < 1e-3


def test_the_sigmas_say_how_far_off_the_numbers_are() -> None:
    """Over several draws of noise, errors are about as large as told."""
    placed = list(placements(LENS, CHESS, 10, seed=4))
    ratios = []
    for draw in range(12):
        seen = [exact_view(f"{draw} {number}", each, noise=0.3) for number, each in enumerate(placed)]
        found = solve_lens(seen, SIZE, holdout=False)
        ratios.append((found.parameters["fx"] - LENS.matrix[0, 0]) / found.sigma["fx"])
    assert 0.3 < np.sqrt(np.mean(np.square(ratios))) < 2


def test_views_it_was_solved_without_fit_nearly_as_well() -> None:
    found = solve_lens(exact(12, noise=0.3), SIZE)
    assert found.holdout_rms is not None
    assert found.rms < found.holdout_rms < 1.5 * found.rms


def test_the_residuals_are_those_of_the_lens_and_poses_told() -> None:
    found = solve_lens(exact(5, noise=0.3), SIZE)
    squares = np.concatenate([view.residuals for view in found.views]) ** 2
    assert found.rms == pytest.approx(np.sqrt(squares.sum() / len(squares)))
    assert [view.name for view in found.views] == ["00", "01", "02", "03", "04"]


def test_the_order_of_the_views_changes_nothing() -> None:
    seen = exact(8, noise=0.3)
    one, other = solve_lens(seen, SIZE), solve_lens(seen[::-1], SIZE)
    assert one.lens.matrix.tobytes() == other.lens.matrix.tobytes()
    assert one.lens.distortion.tobytes() == other.lens.distortion.tobytes()


@pytest.mark.parametrize("coefficients", Coefficients)
def test_a_model_solves_its_numbers_and_no_others(coefficients: Coefficients) -> None:
    found = solve_lens(exact(noise=0.1), SIZE, LensModel(coefficients), holdout=False)
    assert len(found.lens.distortion) == found.model.length
    free = {name for name, value in found.parameters.items() if name[0] in "kp" and value != 0}
    assert free == set(found.model.solved) - {"fx", "fy", "cx", "cy"}
    assert set(found.sigma) == set(found.model.solved)


def test_centre_and_aspect_can_be_fixed() -> None:
    found = solve_lens(exact(noise=0.1), SIZE, LensModel(fixed_centre=True, fixed_aspect=True))
    numbers = found.parameters
    assert (numbers["cx"], numbers["cy"]) == ((SIZE[0] - 1) / 2, (SIZE[1] - 1) / 2)
    assert numbers["fx"] == pytest.approx(numbers["fy"])
    assert "cx" not in found.sigma and found.sigma["fx"] == found.sigma["fy"] > 0


@pytest.mark.parametrize(("count", "said"), [(0, "no view"), (1, "one view"), (2, "2 views")])
def test_too_few_views_are_refused(count: int, said: str) -> None:
    with pytest.raises(LensError, match=said):
        solve_lens(exact()[:count], SIZE)


def test_nonsense_is_refused_instead_of_solved() -> None:
    rng = np.random.default_rng(0)
    wild = [replace(view, pixels=rng.uniform(0, 400, view.pixels.shape)) for view in exact(6)]
    with pytest.raises(LensError, match="No lens explains"):
        solve_lens(wild, SIZE)


def test_a_point_that_is_not_finite_is_refused() -> None:
    first, *others = exact(6)
    pixels = first.pixels.copy()
    pixels[3, 1] = np.nan
    with pytest.raises(LensError, match="00"):
        solve_lens([replace(first, pixels=pixels), *others], SIZE)


def test_views_that_are_all_straight_on_give_no_lens_that_is_trusted() -> None:
    placed = [Placement(np.zeros(3), np.array([-0.1, -0.06, 0.4 + 0.05 * step])) for step in range(8)]
    seen = [exact_view(f"{number}", placement, noise=0.2) for number, placement in enumerate(placed)]
    verdict = judge(solve_lens(seen, SIZE))
    assert verdict.word is Word.DO_NOT_USE
    assert "from nearly one direction" in verdict.reasons[0].text
    assert "turned 30 to 45°" in verdict.next_step


def test_a_lens_that_folds_inside_the_picture_is_known_by_its_reach() -> None:
    assert fold_reach(LENS) > 1
    assert fold_reach(Lens(*SIZE, LENS.matrix, np.zeros(5))) == np.inf
    folding = Lens(*SIZE, LENS.matrix, np.array([-0.6, 0.0, 0.0, 0.0, 0.0]))
    assert 0.5 < fold_reach(folding) < 1


@pytest.mark.parametrize("kept", [slice(0, 8), [0, 7, 32, 39]], ids=["one line", "four points"])
def test_points_that_tell_no_lens_give_none_that_is_trusted(kept: slice | list[int]) -> None:
    few = [
        replace(view, pixels=view.pixels[kept], points=view.points[kept], ids=view.ids[kept])
        for view in exact(5, noise=0.2)
    ]
    try:
        found = solve_lens(few, SIZE)
    except LensError:
        return
    assert np.isfinite(list(found.sigma.values())).all()
    assert judge(found).word is not Word.GOOD
