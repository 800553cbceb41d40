from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.formats.annotations.wildtrack_json import (
    FrameAnnotations,
    PersonPosition,
    frame_json,
    read_frame,
    write_frame,
)
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.grid import Grid

GRID = Grid(480, 1440, 0.025, -3.0, -9.0)
HIDDEN = [-1, -1, -1, -1]


def view(number: int, box: list[int]) -> dict[str, int]:
    return {"viewNum": number, **dict(zip(("xmin", "ymin", "xmax", "ymax"), box, strict=True))}


def entry(
    person: int = 3, position: int = 456826, boxes: Any = ([1510, 139, 1561, 299], HIDDEN)
) -> dict[str, Any]:
    return {
        "personID": person,
        "positionID": position,
        "views": [view(number, box) for number, box in enumerate(boxes)],
    }


def read(data: bytes) -> list[PersonPosition]:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "5.json"
        path.write_bytes(data)
        try:
            return read_frame(path, GRID, 2).people
        except FormatError as error:
            raise error.relative_to(Path(folder)) from error


def parse(entries: Any) -> list[PersonPosition]:
    return read(json.dumps(entries).encode())


def problems_of(data: Any) -> list[str]:
    with pytest.raises(FormatError) as caught:
        read(data if isinstance(data, bytes) else json.dumps(data).encode())
    return [str(problem) for problem in caught.value.problems]


def changed(change: Callable[[dict[str, Any]], object]) -> list[Any]:
    one = entry()
    change(one)
    return [one]


# Reading


def test_a_person_is_read_with_position_and_boxes() -> None:
    (person,) = parse([entry()])
    assert (person.person, person.position) == (3, 456826)
    assert person.boxes is not None
    assert person.boxes.tolist() == [[1510, 139, 1561, 299], HIDDEN]
    assert person.extra == {}


def test_a_frame_without_people_is_read() -> None:
    assert parse([]) == []


def test_further_keys_are_kept() -> None:
    assert parse([{**entry(), "x": 5.65, "origin": "manual"}])[0].extra == {"x": 5.65, "origin": "manual"}


def test_two_people_may_stand_at_one_position() -> None:
    assert len(parse([entry(person=1), entry(person=2)])) == 2


def test_views_in_another_order_are_put_in_order() -> None:
    one = entry()
    one["views"].reverse()
    boxes = parse([one])[0].boxes
    assert boxes is not None
    assert boxes.tolist() == [[1510, 139, 1561, 299], HIDDEN]


def test_a_box_may_begin_at_minus_one() -> None:
    boxes = parse([entry(boxes=([-1, 5, 30, 90], HIDDEN))])[0].boxes
    assert boxes is not None
    assert boxes[0].tolist() == [-1, 5, 30, 90]


def test_views_may_be_left_out() -> None:
    assert parse(changed(lambda one: one.pop("views")))[0].boxes is None


def test_the_frame_number_is_in_the_name(tmp_path: Path) -> None:
    path = tmp_path / "00000005.json"
    path.write_text("[]")
    assert read_frame(path, GRID, 2).number == 5


def test_a_name_without_a_number_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "notes.json"
    path.write_text("[]")
    with pytest.raises(FormatError, match="does not end with a frame number"):
        read_frame(path, GRID, 2)


# What is wrong with a file


@pytest.mark.parametrize(
    "data", [b"{", b"\xff\xfe", b"[" * 100_000, b"[NaN]", b"[1e999]", b"9" * 5000, b'["\\ud800"']
)
def test_what_is_not_json_is_refused(data: bytes) -> None:
    assert "not JSON that can be read" in problems_of(data)[0]


@pytest.mark.parametrize("data", [{}, 3, "x", None, True])
def test_what_is_not_a_list_is_refused(data: object) -> None:
    assert "instead of a list of people" in problems_of(data)[0]


def test_what_is_not_a_person_is_refused() -> None:
    assert problems_of([5]) == ["5.json: entry 0: is 5 instead of an object"]


@pytest.mark.parametrize("key", ["personID", "positionID"])
def test_a_missing_key_is_told(key: str) -> None:
    assert problems_of(changed(lambda one: one.pop(key))) == [f"5.json: entry 0: has no {key}"]


@pytest.mark.parametrize("key", ["personID", "positionID"])
@pytest.mark.parametrize("value", [True, -1, 1.0, "3", None, [3], 10**30])
def test_ids_that_are_not_counts_are_refused(key: str, value: object) -> None:
    assert f"entry 0: {key} is" in problems_of(changed(lambda one: one.update({key: value})))[0]


def test_a_position_outside_the_grid_is_refused() -> None:
    assert len(parse([entry(position=GRID.count - 1)])) == 1
    assert "instead of an integer from 0 to 691199" in problems_of([entry(position=GRID.count)])[0]


def test_a_person_twice_in_a_frame_is_refused() -> None:
    assert problems_of([entry(), entry(position=5)]) == ["5.json: entry 1: person 3 is already in entry 0"]


@pytest.mark.parametrize(
    "views", [3, None, [], [view(0, HIDDEN)], [view(number, HIDDEN) for number in range(3)]]
)
def test_a_wrong_number_of_views_is_refused(views: object) -> None:
    assert "instead of a list of 2" in problems_of(changed(lambda one: one.update(views=views)))[0]


def test_a_view_given_twice_is_refused() -> None:
    views = [view(1, HIDDEN), view(1, HIDDEN)]
    assert "viewNum 1 is there twice" in problems_of(changed(lambda one: one.update(views=views)))[0]


@pytest.mark.parametrize("number", [2, -1, 10**20])
def test_a_view_of_no_camera_is_refused(number: int) -> None:
    assert "instead of 0 to 1" in problems_of(changed(lambda one: one["views"][0].update(viewNum=number)))[0]


@pytest.mark.parametrize("broken", [5, None, "xmin", [], {"viewNum": 0}])
def test_a_view_without_its_keys_is_refused(broken: object) -> None:
    assert (
        "without one of viewNum, xmin"
        in problems_of(changed(lambda one: one["views"].__setitem__(0, broken)))[0]
    )


@pytest.mark.parametrize("value", [True, 1.5, "1", None, []])
@pytest.mark.parametrize("key", ["viewNum", "xmin", "ymax"])
def test_view_values_that_are_not_integers_are_refused(key: str, value: object) -> None:
    assert "not five integers" in problems_of(changed(lambda one: one["views"][0].update({key: value})))[0]


@pytest.mark.parametrize(
    "box", [[50, 10, 40, 90], [10, 90, 40, 10], [10, 10, 10**12, 90], [-(10**12), 1, 2, 3]]
)
def test_impossible_boxes_are_refused(box: list[int]) -> None:
    assert "corners exchanged or too far away" in problems_of([entry(boxes=(box, HIDDEN))])[0]


def test_everything_wrong_is_told_at_once() -> None:
    assert len(problems_of([5, {"personID": True, "views": 3}, entry(position=-3)])) == 5


# Writing


def as_published(people: list[PersonPosition]) -> bytes:
    """The same people through json.dumps, which is how the published files were made."""
    entries = []
    for person in people:
        assert person.boxes is not None
        boxes = person.boxes.tolist()
        entries.append({**entry(int(person.person), int(person.position), boxes), **person.extra})
    return json.dumps(entries, indent=4).encode()


json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)
extras = st.dictionaries(st.text(max_size=4), json_values, max_size=2)
spans = st.tuples(st.integers(-(2**15), 2**15), st.integers(0, 2**15)).map(lambda span: (span[0], sum(span)))
box_lists = st.tuples(spans, spans).map(lambda both: [both[0][0], both[1][0], both[0][1], both[1][1]])


@st.composite
def crowds(draw: st.DrawFn, cameras: int = 2) -> list[PersonPosition]:
    ids = draw(st.lists(st.integers(0, 2**31 - 1), unique=True, max_size=3))
    people = []
    for person in ids:
        boxes = np.array(draw(st.lists(box_lists, min_size=cameras, max_size=cameras)), dtype=np.int32)
        people.append(PersonPosition(person, draw(st.integers(0, GRID.count - 1)), boxes, draw(extras)))
    return people


@given(crowds())
def test_the_bytes_are_those_of_json_dumps(people: list[PersonPosition]) -> None:
    assert frame_json(people, 2) == as_published(people)


@given(crowds())
def test_people_come_back_as_they_were(people: list[PersonPosition]) -> None:
    data = frame_json(people, 2)
    again = read(data)
    assert [(each.person, each.position, each.extra) for each in again] == [
        (each.person, each.position, each.extra) for each in people
    ]
    assert frame_json(again, 2) == data


def test_published_files_come_back_byte_for_byte(shared_data: Path) -> None:
    grid = Grid(1000, 640, 0.025, 0, 0)
    paths = sorted((shared_data / "multiviewx/annotations_positions").glob("*.json"))
    assert len(paths) == 5
    for path in paths:
        assert frame_json(read_frame(path, grid, 6).people, 6) == path.read_bytes()


def test_wildtrack_names_have_eight_digits(tmp_path: Path) -> None:
    assert write_frame(tmp_path, FrameAnnotations(5, []), 7).name == "00000005.json"


BOXES = np.array([[1, 2, 3, 4], HIDDEN], dtype=np.int16)


@pytest.mark.parametrize(
    "people",
    [
        [PersonPosition(1, 1, BOXES), PersonPosition(1, 2, BOXES)],
        [PersonPosition(-1, 1, BOXES)],
        [PersonPosition(1, -1, BOXES)],
        [PersonPosition(1, 1, None)],
        [PersonPosition(1, 1, BOXES[:1])],
        [PersonPosition(1, 1, BOXES.astype(float))],
        [PersonPosition(1, 1, BOXES, {"views": []})],
        [PersonPosition(1, 1, BOXES, {"x": float("nan")})],
    ],
    ids=["twice", "person", "position", "no boxes", "one box", "floats", "hiding", "nan"],
)
def test_what_no_reader_would_take_is_not_written(people: list[PersonPosition]) -> None:
    with pytest.raises(ValueError):
        frame_json(people, 2)


# Whatever bytes come


@settings(max_examples=200)
@given(st.binary(max_size=200) | json_values.map(lambda value: json.dumps(value).encode()))
def test_any_bytes_are_either_read_or_refused(data: bytes) -> None:
    try:
        read(data)
    except FormatError as error:
        assert error.problems


@settings(max_examples=200)
@given(st.dictionaries(st.sampled_from(["personID", "positionID", "views", "viewNum"]), json_values))
def test_any_person_is_either_read_or_refused(one: dict[str, Any]) -> None:
    nearly = {**entry(), **one}
    try:
        parse([nearly, {"views": [one, one]}, one])
    except FormatError as error:
        assert error.problems
