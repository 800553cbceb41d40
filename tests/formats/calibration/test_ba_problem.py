from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gtm_hit.formats.calibration.ba_problem import (
    BaProblem,
    Sightings,
    ba_problem_text,
    parse_ba_problem,
    read_ba_problem,
)
from gtm_hit.formats.problems import FormatError

CAMERA = ["0.1 0.2 0.3", "100 200 300", "1700 1701", "960 540", "-0.4 0.2 0.05 0.001 0.002"]
SMALL = ["1 1 1 1 1", "0 0 10.5 20", "0 0 30 40", *CAMERA, "100", "200", "180", "500", "600", "0"]


def problems_of(lines: list[str]) -> list[tuple[str, str]]:
    with pytest.raises(FormatError) as caught:
        parse_ba_problem("\n".join(lines).encode(), "ba_problem.txt")
    return [(problem.place, problem.reason) for problem in caught.value.problems]


def changed(line: int, text: str) -> list[str]:
    return [*SMALL[: line - 1], text, *SMALL[line:]]


def test_lengths_become_metres_and_the_lens_opencvs_order() -> None:
    problem = parse_ba_problem("\n".join(SMALL).encode(), "ba_problem.txt")
    assert problem.cameras[0].tolist() == [
        *(0.1, 0.2, 0.3, 1.0, 2.0, 3.0, 1700.0, 1701.0, 960.0, 540.0),
        *(-0.4, 0.2, 0.001, 0.002, 0.05),
    ]
    assert problem.points.tolist() == [[1.0, 2.0, 1.8]]
    assert problem.fixed_points.tolist() == [[5.0, 6.0, 0.0]]
    assert problem.seen.pixels.tolist() == [[10.5, 20.0]]
    assert problem.fixed_seen.pixels.tolist() == [[30.0, 40.0]]


def test_a_file_in_metres_keeps_its_numbers() -> None:
    problem = parse_ba_problem("\n".join(SMALL).encode(), "ba_problem.txt", unit="m")
    assert problem.points.tolist() == [[100.0, 200.0, 180.0]]


def test_line_breaks_mean_nothing() -> None:
    one = parse_ba_problem(" ".join(SMALL).encode(), "ba_problem.txt")
    assert ba_problem_text(one) == ba_problem_text(parse_ba_problem("\n".join(SMALL).encode(), "x"))


numbers = st.floats(-1e4, 1e4, allow_subnormal=False)


@st.composite
def files(draw: st.DrawFn) -> BaProblem:
    cameras, points, fixed = (draw(st.integers(1, 3)) for _ in range(3))

    def seen(count: int) -> Sightings:
        pairs = sorted(draw(st.sets(st.tuples(st.integers(0, cameras - 1), st.integers(0, count - 1)))))
        table = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        return Sightings(
            table[:, 0], table[:, 1], draw(arrays(np.float64, (len(pairs), 2), elements=numbers))
        )

    return BaProblem(
        draw(arrays(np.float64, (cameras, 15), elements=numbers)),
        draw(arrays(np.float64, (points, 3), elements=numbers)),
        draw(arrays(np.float64, (fixed, 3), elements=numbers)),
        seen(points),
        seen(fixed),
    )


@given(files(), st.sampled_from(["cm", "m", "mm"]))
def test_what_is_written_is_read_back(problem: BaProblem, unit: str) -> None:
    again = parse_ba_problem(ba_problem_text(problem, unit).encode(), "ba_problem.txt", unit)
    for name in ("cameras", "points", "fixed_points"):
        np.testing.assert_allclose(getattr(again, name), getattr(problem, name), rtol=1e-13, atol=1e-300)
    for name in ("seen", "fixed_seen"):
        for part in ("cameras", "points", "pixels"):
            assert (getattr(getattr(again, name), part) == getattr(getattr(problem, name), part)).all()


def test_the_published_problem_is_written_as_it_was_read(shared_data: Path, tmp_path: Path) -> None:
    path = shared_data / "calibration" / "wildtrack_ba" / "ba_problem.txt"
    problem = read_ba_problem(path)
    assert (len(problem.cameras), len(problem.points), len(problem.fixed_points)) == (7, 1434, 48)
    assert (len(problem.seen.pixels), len(problem.fixed_seen.pixels)) == (4082, 150)
    theirs = [float(word) for word in path.read_text().split()]
    assert [float(word) for word in ba_problem_text(problem).split()] == theirs


@pytest.mark.parametrize(
    ("lines", "place", "reason"),
    [
        (changed(1, "1 1 1 1 x"), "line 1", "observations of fixed points is 'x'"),
        (changed(1, "0 1 1 1 1"), "line 1", "no camera"),
        (changed(1, "1 1 1 2 1"), "line 1", "which makes 38 numbers; there are 34"),
        (changed(2, "1 0 10.5 20"), "line 2", "the camera is '1' instead of an integer from 0 to 0"),
        (changed(2, "0 7 10.5 20"), "line 2", "the point is '7' instead of an integer from 0 to 0"),
        (changed(3, "0 0 nan 40"), "line 3", "x is 'nan' instead of a finite number"),
        (changed(3, "0 0 4.5e18 40"), "line 3", "which is in no picture"),
        (changed(6, "1700 focal"), "line 6", "'focal' instead of a finite number"),
        (SMALL[:-1], "line 1", "there are 33"),
        (["1 1 0 2 0", "0 0 1 2", "0 0 3 4", *CAMERA, "1 2 3"], "line 3", "already in line 2"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(lines: list[str], place: str, reason: str) -> None:
    problems = problems_of(lines)
    assert any(where == place and reason in why for where, why in problems), problems


def test_all_that_is_wrong_is_told_at_once() -> None:
    assert len(problems_of([*changed(2, "3 9 a b")])) == 4
