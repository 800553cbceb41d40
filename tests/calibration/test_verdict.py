"""Good, usable or not: by more than the RMS, with what to do next."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gtm_hit.calibration.intrinsics import LensSolution, solve_lens
from gtm_hit.calibration.lens_models import Coefficients, LensModel
from gtm_hit.calibration.lens_report import lens_report
from gtm_hit.calibration.verdict import Word, judge, outlier, worst_view
from gtm_hit.calibration.views import BoardView
from gtm_hit.demo.boards import Placement, placements
from tests.calibration.board_scene import CHESS, LENS, SIZE, exact_view, views


def seen(count: int = 14, noise: float = 0.05) -> list[BoardView]:
    placed = placements(LENS, CHESS, count, seed=4)
    return [exact_view(f"{number:02d}", placement, noise=noise) for number, placement in enumerate(placed)]


def with_lens(solution: LensSolution, **changes: float) -> LensSolution:
    matrix = solution.lens.matrix.copy()
    places = {"fx": (0, 0), "fy": (1, 1), "cx": (0, 2), "cy": (1, 2)}
    for name, value in changes.items():
        matrix[places[name]] = value
    return replace(solution, lens=replace(solution.lens, matrix=matrix))


@pytest.fixture(scope="module")
def solution() -> LensSolution:
    return solve_lens(seen(), SIZE)


def codes(solution: LensSolution) -> set[str]:
    return {reason.code for reason in judge(solution).reasons}


def test_a_lens_of_many_sharp_views_all_ways_is_good() -> None:
    verdict = judge(solve_lens(views("chessboard", 12), SIZE))
    assert (verdict.word, verdict.reasons) == (Word.GOOD, ())
    assert "go on" in verdict.next_step


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"cy": 700.0}, "centre outside"),
        ({"cx": -3.0}, "centre outside"),
        ({"fx": 620.0}, "aspect"),
    ],
)
def test_numbers_no_camera_has_are_not_to_be_used_however_small_the_rms(
    solution: LensSolution, changes: dict[str, float], code: str
) -> None:
    wrong = with_lens(solution, **changes)
    assert wrong.rms < 0.1
    assert judge(wrong).word is Word.DO_NOT_USE
    assert judge(wrong).reasons[0].code == code


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"sigma": {"fx": 4.0, "fy": 4.0, "cx": 1.0, "cy": 1.0}}, Word.USABLE),
        ({"sigma": {"fx": 40.0, "fy": 4.0, "cx": 1.0, "cy": 1.0}}, Word.DO_NOT_USE),
        ({"sigma": {"fx": 1.0, "fy": 1.0, "cx": 30.0, "cy": 1.0}}, Word.DO_NOT_USE),
        ({"rms": 0.8}, Word.USABLE),
        ({"rms": 3.0}, Word.DO_NOT_USE),
        ({"holdout_rms": 1.2}, Word.USABLE),
        ({"holdout_rms": 20.0}, Word.DO_NOT_USE),
        ({"holdout_rms": None}, Word.DO_NOT_USE),
    ],
)
def test_the_word_follows_from_what_is_unsure(
    solution: LensSolution, changes: dict[str, Any], word: Word
) -> None:
    assert judge(replace(solution, **changes)).word is word


def test_a_lens_that_folds_in_the_picture_is_told(solution: LensSolution) -> None:
    folding = replace(solution, lens=replace(solution.lens, distortion=np.array([-0.5, 0, 0, 0, 0.0])))
    assert "fold" in codes(folding)


def test_few_views_are_usable_at_best() -> None:
    few = judge(solve_lens(seen(6), SIZE))
    assert "few views" in {reason.code for reason in few.reasons}
    assert judge(solve_lens(seen(4), SIZE)).word is Word.DO_NOT_USE


def test_boards_that_lean_one_way_only_are_told_and_where_to_turn_them() -> None:
    one_way = [
        exact_view(
            f"{number}",
            Placement(np.array([0, 0.3 + 0.05 * number, 0]), np.array([-0.2 + 0.03 * number, -0.06, 0.5])),
            noise=0.05,
        )
        for number in range(9)
    ]
    verdict = judge(solve_lens(one_way, SIZE))
    assert "one way" in {reason.code for reason in verdict.reasons}
    assert "face right" in verdict.next_step


def test_a_bad_view_is_named_and_the_next_step_is_to_switch_it_off() -> None:
    good = seen()
    shaken = replace(good[3], pixels=good[3].pixels + np.random.default_rng(0).normal(0, 2, (40, 2)))
    solution = solve_lens([*good[:3], shaken, *good[4:]], SIZE)
    bad = outlier(solution)
    assert bad is not None and bad.name == worst_view(solution).name == "03"
    assert judge(solution).next_step == "Switch off 03 and solve again."
    rest = solve_lens([view for view in good if view.name != "03"], SIZE)
    assert outlier(rest) is None and rest.rms < solution.rms / 3


def test_a_board_in_one_corner_only_is_told_with_the_empty_edge() -> None:
    corner = [view for view in seen(40) if view.pixels[:, 0].max() < 420][:9]
    verdict = judge(solve_lens(corner, SIZE))
    assert "coverage" in {reason.code for reason in verdict.reasons}
    step = next(reason.step for reason in verdict.reasons if reason.code == "coverage")
    assert "right edge" in step


def test_a_rational_model_that_cannot_be_told_is_sent_back_to_five() -> None:
    solution = solve_lens(seen(), SIZE, LensModel(Coefficients.RATIONAL))
    loose = replace(solution, sigma=solution.sigma | {"k1": 5.0})
    assert "loose model" in codes(loose)


def test_a_report_is_json_that_says_the_word_the_numbers_and_the_views(solution: LensSolution) -> None:
    told = json.loads(json.dumps(lens_report(solution, judge(solution)), allow_nan=False))
    assert told["verdict"] in {"good", "usable"}
    assert told["camera_matrix"][0][0] == pytest.approx(LENS.matrix[0, 0], rel=0.005)
    assert {"rms", "sigma", "distortion", "holdout_rms", "reasons", "next_step"} <= set(told)
    assert [view["name"] for view in told["views"]] == [f"{number:02d}" for number in range(14)]
