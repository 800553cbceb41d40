"""Files of the calibration desk, cut, doubled and mixed up: read, or refused in words, and no third."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gtm_hit.calibration.ground_files import parse_points
from gtm_hit.calibration.lens_files import read_lens
from gtm_hit.calibration.pair_files import parse_pairs
from gtm_hit.formats.calibration.ba_problem import parse_ba_problem
from gtm_hit.formats.calibration.clicks import parse_clicks
from gtm_hit.formats.calibration.pos_file import parse_pos
from gtm_hit.formats.calibration.wildtrack_xml import parse_extrinsic, parse_intrinsic
from gtm_hit.formats.files import write_bytes
from gtm_hit.formats.problems import FormatError
from tests.geometry.scenes import FIXTURES

LENS = b'{"camera": "C1", "width": 640, "height": 480, "matrix": [[500, 0, 320], [0, 500, 240], [0, 0, 1]], "distortion": [0, 0, 0, 0, 0]}'  # noqa: E501
XML = b"""<?xml version="1.0"?><opencv_storage><rvec>1 0 0</rvec><tvec>1 2 3</tvec>
<camera_matrix type_id="opencv-matrix"><rows>3</rows><cols>3</cols><dt>d</dt><data>1 0 1 0 1 1 0 0 1</data></camera_matrix>
<distortion_coefficients type_id="opencv-matrix"><rows>5</rows><cols>1</cols><dt>d</dt><data>0 0 0 0 0</data></distortion_coefficients>
</opencv_storage>"""  # noqa: E501
FILES = {
    "clicks.csv": b"thing,camera,x,y,use\nlamp,C1,14,2,test\nlamp,C2,1,5\n",
    "clicks.json": b'[{"thing": "lamp", "camera": "C1", "x": 1.0, "y": 2, "use": "test"}]',
    "points.csv": b"# unit: cm\nname,x,y,z\nA,0,0,0\nB,100,5.5,1\n",
    "points.json": b'{"unit": "cm", "points": [{"name": "A1", "x": 0, "y": 0}, {"name": "B", "x": 1, "y": 2}]}',  # noqa: E501
    "grid.json": b'{"unit": "cm", "grid": {"columns": 4, "rows": 9, "spacing": [2, 3], "origin": [0, 0]}}',
    "pairs.json": b'{"camera": "C1", "unit": "m", "pairs": [{"name": "A1", "point": [0, 0, 0], "pixel": [5, 4]}]}',  # noqa: E501
    "ba_problem.txt": b"1 1 1 1 1\n0 0 1.5 2\n0 0 3 4\n" + b"1\n" * 15 + b"1 2 3\n4 5 6\n",
    "7.pos": b"1 5 5\n2 6 6.5 7 8\n",
    "lens.json": LENS,
    "extr.xml": XML,
    "intr.xml": XML,
}
READERS: dict[str, Callable[[bytes, str], object]] = {
    "clicks.csv": parse_clicks,
    "clicks.json": parse_clicks,
    "points.csv": parse_points,
    "points.json": parse_points,
    "grid.json": parse_points,
    "pairs.json": parse_pairs,
    "ba_problem.txt": parse_ba_problem,
    "7.pos": parse_pos,
    "extr.xml": parse_extrinsic,
    "intr.xml": parse_intrinsic,
}
BITS = [
    b"",
    b"0",
    b"-1",
    b"nan",
    b"1e999",
    b"1e18",
    b"null",
    b"[]",
    b"{}",
    b",",
    b"\n",
    b'"',
    b"\xff",
    b"9" * 400,
]


@st.composite
def edits(draw: st.DrawFn) -> list[tuple[float, float, bytes]]:
    """Where pieces are cut out, as shares of the file, and what comes there instead."""
    share = st.floats(0, 1)
    piece = st.tuples(share, st.floats(0, 0.3), st.sampled_from(BITS))
    return draw(st.lists(piece, min_size=1, max_size=3))


def edited(data: bytes, pieces: list[tuple[float, float, bytes]]) -> bytes:
    for start, length, instead in pieces:
        at = round(start * len(data))
        data = data[:at] + instead + data[at + round(length * len(data)) :]
    return data


@pytest.mark.parametrize("name", READERS)
@given(pieces=edits())
@settings(max_examples=150, deadline=None, derandomize=True)
def test_a_file_that_was_cut_up_is_read_or_refused_in_words(
    name: str, pieces: list[tuple[float, float, bytes]]
) -> None:
    with suppress(FormatError):
        READERS[name](edited(FILES[name], pieces), name)


@given(pieces=edits())
@settings(
    max_examples=100,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_a_lens_that_was_cut_up_is_read_or_refused_in_words(
    tmp_path: Path, pieces: list[tuple[float, float, bytes]]
) -> None:
    path = tmp_path / "lens.json"
    for whole in (LENS, (FIXTURES / "wildtrack_cameras.json").read_bytes()):
        write_bytes(path, edited(whole, pieces))
        with suppress(FormatError):
            read_lens(path, "C1")


def test_a_line_of_one_word_is_named_instead_of_breaking_the_reader() -> None:
    with pytest.raises(FormatError, match=r"line 1: is no line of the form thing,camera,x,y"):
        parse_clicks(b"nan 1e18", "clicks.csv")
