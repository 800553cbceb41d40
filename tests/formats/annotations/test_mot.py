from __future__ import annotations

import configparser
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motmetrics.io import loadtxt

from gtm_hit.formats.annotations.mot import (
    MotTable,
    mot_lines,
    parse_mot,
    places_of,
    read_mot,
    seqinfo,
)
from gtm_hit.formats.problems import FormatError

NUMBERS = (0, 5, 10)


def parse(text: str) -> MotTable:
    return parse_mot(text.encode(), "gt.txt", NUMBERS)


def put(path: Path, table: MotTable) -> Path:
    path.write_bytes(mot_lines(table, places_of(NUMBERS)))
    return path


def problems_of(text: str) -> list[str]:
    with pytest.raises(FormatError) as caught:
        parse(text)
    return [str(problem) for problem in caught.value.problems]


# Reading


def test_ground_truth_of_a_view_is_read_in_our_numbers() -> None:
    table = parse("2,1,1510,139,51,160,1,1,1\n3,1,0,0.5,2,2,0,1,0.3\n")
    assert table.frames.tolist() == [5, 10]
    assert table.persons is not None and table.persons.tolist() == [0, 0]
    assert table.boxes is not None and table.boxes.tolist() == [[1510, 139, 1561, 299], [0, 0.5, 2, 2.5]]
    assert table.confidences.tolist() == [1, 0]
    assert table.world is None
    assert table.lines is not None and table.lines.tolist() == [1, 2]


def test_the_largest_person_comes_back(tmp_path: Path) -> None:
    largest = parse("1,2147483648,1,2,3,4,1,1,1\n")
    assert largest.persons is not None and largest.persons.tolist() == [2**31 - 1]
    assert read_mot(put(tmp_path / "gt.txt", largest), NUMBERS).persons == largest.persons


def test_detections_have_no_identities() -> None:
    table = parse("1,-1,1,2,3,4,0.75,-1,-1,-1\n")
    assert table.persons is None
    assert table.confidences.tolist() == [0.75]


def test_places_on_the_ground_have_no_boxes() -> None:
    table = parse("1,4,-1,-1,-1,-1,1,5.65,-9,0\n")
    assert table.boxes is None
    assert table.world is not None and table.world.tolist() == [[5.65, -9, 0]]


@pytest.mark.parametrize(
    "line", ["1,3,1,2,3,4", "1,3,1,2,3,4,1", "1,3,1,2,3,4,1,1,1", "1,3,1,2,3,4,1,-1,-1,-1"]
)
def test_lines_of_every_published_length_are_read(line: str) -> None:
    boxes = parse(line).boxes
    assert boxes is not None and boxes.tolist() == [[1, 2, 4, 6]]


def test_an_empty_text_has_nobody() -> None:
    assert parse("\n").frames.size == 0


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("0,1,1,2,3,4,1,1,1", "frame is '0' instead of an integer from 1"),
        ("4,1,1,2,3,4,1,1,1", "frame 4 is not one of the dataset's 3"),
        ("1,0,1,2,3,4,1,1,1", "id is 0, but ids count from 1"),
        ("1,-2,1,2,3,4,1,1,1", "id is '-2' instead of an integer from -1"),
        ("1,-1,1,2,3,4,1,1,1", "id is -1 while other lines have one"),
        ("1,1,1,2,0,4,1,1,1", "the box 1.0 2.0 0.0 4.0 has no area"),
        ("1,1,nan,2,3,4,1,1,1", "left is 'nan' instead of a finite number"),
        ("1,1,1,2,3,4,x,1,1", "confidence is 'x' instead of a finite number"),
        ("1,1,-1,-1,-1,-1,1,1,1", "has neither a box nor a place"),
        ("1,1,1,2,3,4,1", "7 values instead of frame,id,left"),
    ],
)
def test_a_wrong_line_is_told_with_its_number(line: str, reason: str) -> None:
    (problem,) = problems_of(f"1,9,1,2,3,4,1,1,1\n{line}\n")
    assert problem.startswith(f"gt.txt: line 2: {reason}")


def test_lines_of_another_length_are_told() -> None:
    assert problems_of("1,2,3\n") == ["gt.txt: line 1: 3 values instead of 6, 7, 9 or 10"]


# Writing

BOXES = np.array([[1510.0, 139, 1561, 299], [-5, 0, 10, 99.5]])


def table(**changes: object) -> MotTable:
    values = {
        "frames": np.array([0, 10]),
        "persons": np.array([0, 4]),
        "boxes": BOXES,
        "confidences": np.ones(2),
    }
    return MotTable(**(values | changes))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changes", "lines"),
    [
        ({}, ["1,1,1510,139,51,160,1,1,1", "3,5,-5,0,15,99.5,1,1,1"]),
        (
            {"persons": None, "confidences": np.array([0.25, 1])},
            ["1,-1,1510,139,51,160,0.25,-1,-1,-1", "3,-1,-5,0,15,99.5,1,-1,-1,-1"],
        ),
        (
            {"boxes": None, "world": np.array([[5.65, -9, 0], [0.025, 0, 0]])},
            ["1,1,-1,-1,-1,-1,1,5.65,-9,0", "3,5,-1,-1,-1,-1,1,0.025,0,0"],
        ),
    ],
    ids=["truth", "detections", "ground"],
)
def test_each_kind_is_written_as_the_benchmark_has_it(changes: dict[str, object], lines: list[str]) -> None:
    assert mot_lines(table(**changes), places_of(NUMBERS)).decode().splitlines() == lines


def test_a_frame_the_dataset_does_not_have_is_not_written() -> None:
    with pytest.raises(KeyError):
        mot_lines(table(frames=np.array([0, 7])), places_of(NUMBERS))


def test_sequence_facts_are_read_by_configparser() -> None:
    parser = configparser.ConfigParser()
    parser.read_string(seqinfo("C1", 400, 2.0, 1920, 1080, ".png").decode())
    assert dict(parser["Sequence"]) == {
        "name": "C1",
        "imdir": "img1",
        "framerate": "2",
        "seqlength": "400",
        "imwidth": "1920",
        "imheight": "1080",
        "imext": ".png",
    }


def test_motmetrics_reads_what_was_written(tmp_path: Path) -> None:
    theirs = loadtxt(str(put(tmp_path / "gt.txt", table())), fmt="mot16", min_confidence=1)
    assert theirs.index.tolist() == [(1, 1), (3, 5)]
    # motmetrics shifts the benchmark's pixels, which count from 1.
    assert (theirs[["X", "Y"]].to_numpy() + 1).tolist() == [[1510, 139], [-5, 0]]
    assert theirs[["Width", "Height"]].to_numpy().tolist() == [[51, 160], [15, 99.5]]


numbers = st.integers(-(10**6), 10**6).map(lambda value: value / 100)
sizes = st.integers(1, 10**6).map(lambda value: value / 100)


@st.composite
def tables(draw: st.DrawFn) -> MotTable:
    keys = draw(
        st.lists(
            st.tuples(st.sampled_from(NUMBERS), st.integers(0, 2**31 - 2)),
            unique=True,
            min_size=1,
            max_size=5,
        )
    )
    frames, persons = np.array(keys, dtype=np.int64).T
    corners = np.array([[draw(numbers), draw(numbers)] for _ in keys])
    spans = np.array([[draw(sizes), draw(sizes)] for _ in keys])
    world = np.array([[draw(numbers), draw(numbers), 0.0] for _ in keys])
    kind = draw(st.sampled_from(["truth", "detections", "ground", "both"]))
    return MotTable(
        frames,
        None if kind == "detections" else persons,
        None if kind == "ground" else np.hstack([corners, corners + spans]),
        np.array([draw(st.sampled_from([1.0, 0.125])) for _ in keys]),
        world if kind in ("ground", "both") else None,
    )


@given(tables())
def test_what_was_written_comes_back(one: MotTable) -> None:
    with TemporaryDirectory() as folder:
        again = read_mot(put(Path(folder) / "gt.txt", one), NUMBERS)
    for name in ("frames", "persons", "boxes", "confidences", "world"):
        ours, theirs = getattr(one, name), getattr(again, name)
        assert (ours is None) == (theirs is None)
        assert ours is None or np.allclose(ours, theirs, rtol=0, atol=2e-6)


WORDS = st.sampled_from(
    ["1", "2", "-1", "0", "0.5", "x", "nan", "", "\n", "1\n2", "#", "9" * 50, "1e300", "1e999"]
)


@settings(max_examples=200)
@given(st.binary(max_size=200) | st.lists(WORDS, max_size=40).map(lambda words: ",".join(words).encode()))
def test_any_bytes_are_either_read_or_refused(data: bytes) -> None:
    for head in (b"", b"1,1,1,2,3,4,1,1,1\n", b"1,1,1,2,3,4,1,1,1,1\n1,1,"):
        try:
            parse_mot(head + data, "a", NUMBERS)
        except FormatError as error:
            assert error.problems
