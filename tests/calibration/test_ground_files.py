from __future__ import annotations

import json

import pytest

from gtm_hit.calibration.ground_files import parse_points
from gtm_hit.calibration.ground_points import GroundPointsError, regular_grid
from gtm_hit.calibration.pair_files import parse_pairs
from gtm_hit.formats.problems import FormatError

PLAIN = "name,x,y\nA,0,0\nB,2.5,0\nC,0,2\nD,2.5,2\n"


def read(text: str, unit: str = "m"):
    return parse_points(text.encode(), "points.csv", unit)


def problems(text: str, unit: str = "m") -> list[str]:
    with pytest.raises(FormatError) as caught:
        read(text, unit)
    return [str(problem).removeprefix("points.csv: ") for problem in caught.value.problems]


def test_a_plain_csv_is_read() -> None:
    assert [(point.name, point.place) for point in read(PLAIN).points] == [
        ("A", (0.0, 0.0, 0.0)),
        ("B", (2.5, 0.0, 0.0)),
        ("C", (0.0, 2.0, 0.0)),
        ("D", (2.5, 2.0, 0.0)),
    ]


@pytest.mark.parametrize(
    "text",
    [
        "name,x_cm,y_cm\nA,0,0\nB,250,0\nC,0,200\n",
        "# unit: cm\nname,y,x\nA,0,0\nB,0,250\nC,200,0\n",
        "point;x [cm];y [cm];z [cm]\nA;0;0;0\nB;250,0;0;0\nC;0;200,0;0\n",
        "A\t0\t0\nB\t250\t0\nC\t0\t200\n",
        '{"unit": "cm", "points": [{"name": "A", "x": 0, "y": 0}, {"name": "B", "x": 250, "y": 0},'
        ' {"name": "C", "x": 0, "y": 200, "z": 0}]}',
    ],
)
def test_headings_separators_and_units_are_understood(text: str) -> None:
    points = read(text, "cm").points
    assert [(point.name, round(point.x, 9), round(point.y, 9)) for point in points] == [
        ("A", 0.0, 0.0),
        ("B", 2.5, 0.0),
        ("C", 0.0, 2.0),
    ]


def test_a_regular_grid_needs_only_its_numbers() -> None:
    text = '{"unit": "cm", "grid": {"columns": 4, "rows": 9, "spacing": [259, 207], "origin": [0, 0]}}'
    points = read(text, "").points
    assert len(points) == 36
    assert (points[-1].name, points[-1].place) == ("D9", pytest.approx((7.77, 16.56, 0.0)))


def test_a_grid_nobody_can_have_measured_is_refused() -> None:
    with pytest.raises(GroundPointsError):
        regular_grid(0, 5, (1.0, 1.0))
    with pytest.raises(GroundPointsError):
        regular_grid(3, 3, (0.0, 1.0))


def test_everything_wrong_is_told_at_once_with_its_line() -> None:
    text = "name,x,y\nA,0,0\nB,nan,0\nA,1,one\n,1,2\nC,1\nD,0,0\n"
    told = problems(text)
    assert any("line 3" in line and "'nan'" in line for line in told)
    assert any("line 4" in line and "'one'" in line for line in told)
    assert any("line 4" in line and "given already: line 2" in line for line in told)
    assert any("line 5" in line and "is no name" in line for line in told)
    assert any("line 6" in line and "2 values instead of 3" in line for line in told)
    assert any("line 7" in line and "lies where 'A', line 2 does already" in line for line in told)


def test_a_unit_must_be_said_and_the_likely_one_is_told() -> None:
    text = "name,x,y\nA,0,0\nB,777,0\nC,0,1656\n"
    assert problems(text, "") == ["unit: not said: m, cm or mm (a span of 1,656 looks like centimetres)"]


def test_two_units_contradict() -> None:
    assert "mixes units: cm, m" in problems("name,x_cm,y_m\nA,0,0\n")[0]
    assert problems("name,x_cm,y_cm\nA,0,0\nB,9,9\n", "m") == ["unit: the file says cm, you say m"]


def test_centimetres_said_to_be_metres_are_doubted() -> None:
    (told,) = read("name,x,y\nA,0,0\nB,777,0\nC,0,1656\n").doubts
    assert told == "The points span 1,656 m: this looks like centimetres, not metres."


def test_one_point_in_another_unit_is_doubted_by_name() -> None:
    (told,) = read(PLAIN + "E,250,400\n").doubts
    assert told == "Point E looks like centimetres among points in larger units."


def test_a_point_one_centimetre_off_its_grid_is_doubted_by_name() -> None:
    rows = [f"{x}-{y},{x},{y}" for x in (0, 259, 518) for y in (0, 207, 414)]
    rows[-1] = "slip,519,414"
    (told,) = read("\n".join(["name,x_cm,y_cm", *rows]), "").doubts
    assert told == "X of point slip is 519 cm, 1 cm off the 2 others at 518 cm."


@pytest.mark.parametrize("text", ["", "{", "[]", '{"points": 3}', "name,x\nA,1\n", "name,x,y\n"])
def test_what_holds_no_points_is_refused(text: str) -> None:
    with pytest.raises(FormatError):
        read(text)


def pairs_of(content: object, **more):
    return parse_pairs(json.dumps(content).encode(), "pairs.json", **more)


def test_pairs_bring_their_points_or_name_them() -> None:
    own = pairs_of({"unit": "cm", "pairs": [{"name": "A", "point": [250, 0], "pixel": [5, 6]}]})
    named = pairs_of({"camera": "C3", "pairs": [{"name": "B", "pixel": [5, 6]}]}, points=read(PLAIN))
    assert own.pairs[0].point == pytest.approx(named.pairs[0].point)
    assert (named.camera, named.pairs[0].pixel) == ("C3", (5.0, 6.0))


def test_two_lists_are_pairs_numbered_from_one() -> None:
    found = pairs_of({"unit": "m", "object_points": [[0, 0, 0], [1, 0, 0]], "image_points": [[1, 2], [3, 4]]})
    assert [(pair.name, pair.pixel) for pair in found.pairs] == [("1", (1.0, 2.0)), ("2", (3.0, 4.0))]


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ({"pairs": []}, "neither a list"),
        ({"pairs": [{"name": "Z", "pixel": [1, 2]}]}, "no measured point is named 'Z'"),
        ({"pairs": [{"name": "A", "pixel": [1]}]}, "pairs[0].pixel"),
        ({"pairs": [{"name": "A", "pixel": [1, 2]}, {"name": "A", "pixel": [1, 2]}]}, "clicked twice"),
        ({"object_points": [[0, 0]], "image_points": []}, "same length"),
        ([], "not an object"),
    ],
)
def test_broken_pairs_are_refused_with_a_sentence(content: object, told: str) -> None:
    with pytest.raises(FormatError, match=told.replace("[", r"\[").replace("]", r"\]")):
        pairs_of(content, points=read(PLAIN))
