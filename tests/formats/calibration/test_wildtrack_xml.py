from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gtm_hit.formats.calibration.wildtrack_xml import (
    DISTORTION_COUNTS,
    Extrinsic,
    Intrinsic,
    Style,
    extrinsic_xml,
    intrinsic_xml,
    parse_extrinsic,
    parse_intrinsic,
    read_extrinsic,
    read_intrinsic,
)
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import CameraModel

MATRIX = "900.5 0 960 0 901.5 540 0 0 1"
NUMBERS = [900.5, 0, 960, 0, 901.5, 540, 0, 0, 1]


def storage(*nodes: str) -> bytes:
    return f'<?xml version="1.0"?>\n<opencv_storage>\n{"".join(nodes)}</opencv_storage>\n'.encode()


def matrix_node(name: str, rows: int, cols: int, data: str, dt: str = "d") -> str:
    return (
        f'<{name} type_id="opencv-matrix"><rows>{rows}</rows><cols>{cols}</cols>'
        f"<dt>{dt}</dt><data>{data}</data></{name}>"
    )


def camera_matrix(data: str = MATRIX) -> str:
    return matrix_node("camera_matrix", 3, 3, data)


def reasons(data: bytes, parse: object = parse_intrinsic, path: str = "file.xml") -> list[str]:
    with pytest.raises(FormatError) as caught:
        parse(data, path)  # type: ignore[operator]
    return [str(problem) for problem in caught.value.problems]


def file_storage(data: bytes) -> cv2.FileStorage:
    return cv2.FileStorage(data.decode(), cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)


# Published files


def test_wildtracks_bare_text_pose_is_read_in_its_own_unit(shared_data: Path) -> None:
    pose = read_extrinsic(shared_data / "wildtrack/calibrations/extrinsic/extr_CVLab1.xml")
    assert pose.rvec.tolist() == [1.759099006652832, 0.46710100769996643, -0.331699013710022]
    assert pose.tvec.tolist() == [-525.8941650390625, 45.40763473510742, 986.7235107421875]


def test_wildtracks_distorted_intrinsics_are_read(shared_data: Path) -> None:
    lens = read_intrinsic(shared_data / "wildtrack/calibrations/intrinsic_original/intr_CVLab1.xml")
    assert lens.matrix[0].tolist() == [1743.4478759765625, 0.0, 934.5202026367188]
    assert lens.distortion[0] == -0.43248599767684937
    assert lens.distortion.shape == (5,)


def test_every_published_calibration_file_is_read(shared_data: Path) -> None:
    files = sorted(shared_data.glob("*/calibrations/*/*.xml"))
    assert len(files) == 33
    for path in files:
        (read_extrinsic if path.name.startswith("extr_") else read_intrinsic)(path)


def test_multiviewx_is_read_as_opencv_reads_it(shared_data: Path) -> None:
    for path in sorted(shared_data.glob("multiviewx/calibrations/intrinsic/*.xml")):
        lens = read_intrinsic(path)
        theirs = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
        assert np.array_equal(lens.matrix, theirs.getNode("camera_matrix").mat())
        assert np.array_equal(lens.distortion, theirs.getNode("distortion_coefficients").mat().ravel())


# Ways of writing


@pytest.mark.parametrize(
    "name", ["camera_matrix", "cameraMatrix", "Camera_Matrix", "K", "intrinsic_matrix", "mtx"]
)
def test_the_camera_matrix_goes_by_many_names(name: str) -> None:
    assert (
        parse_intrinsic(storage(matrix_node(name, 3, 3, MATRIX)), "a.xml").matrix.ravel().tolist() == NUMBERS
    )


@pytest.mark.parametrize(
    "name", ["distortion_coefficients", "distCoeffs", "dist_coeffs", "D", "DistortionCoeffs"]
)
def test_distortion_goes_by_many_names(name: str) -> None:
    data = storage(camera_matrix(), matrix_node(name, 1, 4, "1 2 3 4"))
    assert parse_intrinsic(data, "a.xml").distortion.tolist() == [1, 2, 3, 4]


@pytest.mark.parametrize("count", DISTORTION_COUNTS)
@pytest.mark.parametrize("upright", [True, False])
def test_distortion_may_be_a_row_or_a_column_of_any_count_opencv_knows(count: int, upright: bool) -> None:
    shape = (count, 1) if upright else (1, count)
    data = storage(camera_matrix(), matrix_node("D", *shape, " ".join(map(str, range(count)))))
    assert parse_intrinsic(data, "a.xml").distortion.tolist() == list(range(count))


@pytest.mark.parametrize("node", ["", matrix_node("D", 0, 0, ""), "<D></D>"])
def test_no_distortion_means_five_zeros(node: str) -> None:
    assert parse_intrinsic(storage(camera_matrix(), node), "a.xml").distortion.tolist() == [0] * 5


def test_comments_and_other_nodes_are_passed_over() -> None:
    data = storage("<!-- made by hand -->", "<calibration_time>Mon 1 Jan</calibration_time>", camera_matrix())
    assert parse_intrinsic(data, "a.xml").matrix.ravel().tolist() == NUMBERS


def test_bare_text_and_sequences_and_single_precision_are_read() -> None:
    data = storage("<rvec><_>.1</_><_>2.</_><_>-3e-1</_></rvec>", matrix_node("tvec", 1, 1, "1 2 3", dt="3f"))
    pose = parse_extrinsic(data, "a.xml")
    assert pose.rvec.tolist() == [0.1, 2.0, -0.3]
    assert pose.tvec.tolist() == [1, 2, 3]


def test_a_camera_inside_another_node_is_found() -> None:
    assert parse_intrinsic(storage(f"<left>{camera_matrix()}</left>"), "a.xml").matrix[0, 0] == 900.5


def test_one_file_may_hold_both_parts() -> None:
    data = storage(camera_matrix(), "<rvec>1 2 3</rvec><tvec>4 5 6</tvec>")
    assert parse_intrinsic(data, "a.xml").matrix[0, 0] == 900.5
    assert parse_extrinsic(data, "a.xml").tvec.tolist() == [4, 5, 6]


def test_a_rotation_matrix_stands_for_a_rotation_vector() -> None:
    rvec = np.array([0.3, -1.2, 0.5])
    rotation = " ".join(map(repr, cv2.Rodrigues(rvec)[0].ravel().tolist()))
    data = storage(matrix_node("R", 3, 3, rotation), "<T>1 2 3</T>")
    assert parse_extrinsic(data, "a.xml").rvec == pytest.approx(rvec, abs=1e-12)


OPENCV_HEAD = "K: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
YAML_MATRICES = {
    "OpenCV": f"%YAML:1.0\n---\n{OPENCV_HEAD}   data: [ 900.5, 0., 960.,\n  0., 901.5, 540., 0., 0., 1. ]\n",
    "OpenCV 5": f"%YAML 1.2\n---\n{OPENCV_HEAD}   data: [ 900.5, 0, 960, 0, 901.5, 540, 0, 0, 1 ]\n",
    "ROS": "width: 1920\nK:\n  rows: 3\n  cols: 3\n  data: [900.5, 0, 960, 0, 901.5, 540, 0, 0, 1]\n",
    "flow rows": "K: [[900.5, 0, 960], [0, 901.5, 540],\n  [0, 0, 1]]  # by hand\n",
    "block rows": "K:\n- - 900.5\n  - 0\n  - 960\n- - 0\n  - 901.5\n  - 540\n- - 0\n  - 0\n  - 1\n",
    "items at the indent of the name": "K:\n- [900.5, 0, 960]\n- [0, 901.5, 540]\n- [0, 0, 1]\nother: 1\n",
    "nested": "left:\n  K: [900.5, 0, 960, 0, 901.5, 540, 0, 0, 1]\nright:\n  width: 3\n",
}


@pytest.mark.parametrize("text", YAML_MATRICES.values(), ids=YAML_MATRICES.keys())
def test_yaml_is_read_as_it_is_written_in_the_field(text: str) -> None:
    assert parse_intrinsic(text.encode(), "a.yml").matrix.ravel().tolist() == NUMBERS


def test_negative_numbers_of_yaml_lists_keep_their_sign() -> None:
    pose = parse_extrinsic(b"rvec:\n- -1.5\n-  2\n- -3\ntvec: [-1, -2.5, -3e1]\n", "a.yaml")
    assert pose.rvec.tolist() == [-1.5, 2, -3]
    assert pose.tvec.tolist() == [-1, -2.5, -30]


# What is wrong with a file


def test_a_missing_node_is_named() -> None:
    assert reasons(storage("<rvec>1 2 3</rvec>")) == ["file.xml: no camera_matrix in this file"]


def test_all_problems_of_a_file_are_told_at_once() -> None:
    assert reasons(storage("<rvec>1 nan x</rvec>"), parse_extrinsic) == [
        "file.xml: rvec: value 2 is not finite: 'nan'",
        "file.xml: rvec: value 3 is not a number: 'x'",
        "file.xml: no tvec in this file",
    ]


@pytest.mark.parametrize("word", ["nan", ".Nan", "inf", "-.Inf", "1e999", "-1.#IND"])
def test_numbers_that_are_not_finite_are_refused(word: str) -> None:
    assert "not finite" in reasons(storage(camera_matrix(MATRIX.replace("960", word))))[0]


@pytest.mark.parametrize("word", ["1_000", "0x10", "one", "1,5e", "١"])
def test_words_that_only_python_takes_for_numbers_are_refused(word: str) -> None:
    assert "not a number" in reasons(storage(camera_matrix(MATRIX.replace("960", word))))[0]


def test_a_wrong_count_is_told_with_the_count() -> None:
    assert reasons(storage("<K>1 2 3</K>")) == ["file.xml: K: 3 numbers where 9 are expected"]


def test_a_count_that_differs_from_rows_and_columns_is_told() -> None:
    assert reasons(storage(camera_matrix("900 0 0 0 900 0 0 0"))) == [
        "file.xml: camera_matrix: 8 numbers where 3 x 3 asks for 9",
        "file.xml: camera_matrix: 8 numbers where 9 are expected",
    ]


def test_three_distortion_coefficients_are_refused() -> None:
    assert (
        "3 numbers where 4 or 5 or 8 or 12 or 14 are expected"
        in reasons(storage(camera_matrix(), "<D>1 2 3</D>"))[0]
    )


@pytest.mark.parametrize("matrix", ["0 0 1 0 900 1 0 0 1", "900 0 1 0 -900 1 0 0 1", "0 0 0 0 0 0 0 0 1"])
def test_a_singular_or_mirrored_matrix_is_refused(matrix: str) -> None:
    assert "not both positive" in reasons(storage(camera_matrix(matrix)))[0]


def test_a_last_row_other_than_0_0_1_is_refused() -> None:
    assert "last row" in reasons(storage(camera_matrix("900 0 960 0 900 540 0 0 2")))[0]


def test_skew_is_refused_because_projection_would_ignore_it() -> None:
    assert "skew" in reasons(storage(camera_matrix("900 3 960 0 900 540 0 0 1")))[0]


@pytest.mark.parametrize(
    "node", ["<fisheye_model>1</fisheye_model>", "<distortion_model>equidistant</distortion_model>"]
)
def test_fisheye_coefficients_are_not_taken_for_ordinary_ones(node: str) -> None:
    lens = parse_intrinsic(storage(node, camera_matrix(), "<D>1 2 3 4</D>"), "file.xml")
    assert (lens.model, lens.distortion.tolist()) == (CameraModel.FISHEYE, [1, 2, 3, 4])


def test_a_fisheye_with_another_number_of_coefficients_is_refused() -> None:
    node = "<fisheye_model>1</fisheye_model>"
    assert "5 numbers where 4" in reasons(storage(node, camera_matrix(), "<D>1 2 3 4 5</D>"))[0]


@pytest.mark.parametrize("suffix", ["xml", "yml"])
def test_a_fisheye_calibration_as_opencvs_own_program_writes_it_is_read(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"intr_C1.{suffix}"
    written = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    written.write("fisheye_model", 1)
    written.write("camera_matrix", LENS.matrix)
    written.write("distortion_coefficients", np.array([[0.1], [-0.02], [0.003], [-0.0004]]))
    written.release()
    lens = read_intrinsic(path)
    assert lens.model is CameraModel.FISHEYE
    np.testing.assert_array_equal(lens.matrix, LENS.matrix)
    assert lens.distortion.tolist() == [0.1, -0.02, 0.003, -0.0004]


def test_a_fisheye_written_is_read_back_and_by_opencv_too(tmp_path: Path) -> None:
    fisheye = Intrinsic(LENS.matrix, np.array([0.1, -0.02, 0.003, -0.0004]), CameraModel.FISHEYE)
    path = tmp_path / "a.xml"
    path.write_bytes(intrinsic_xml(fisheye))
    again = read_intrinsic(path)
    assert again.model is CameraModel.FISHEYE
    np.testing.assert_array_equal(again.distortion, fisheye.distortion)
    stored = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    assert stored.getNode("fisheye_model").real() == 1
    np.testing.assert_array_equal(stored.getNode("camera_matrix").mat(), LENS.matrix)


@pytest.mark.parametrize(
    "matrix", ["1 0 0 0 1 0 0 0 -1", "2 0 0 0 2 0 0 0 2", "1 1 0 0 1 0 0 0 1", "1e300 0 0 0 1e300 0 0 0 1"]
)
def test_a_matrix_that_does_not_rotate_is_refused(matrix: str) -> None:
    data = storage(f"<R>{matrix}</R><T>1 2 3</T>")
    assert reasons(data, parse_extrinsic) == ["file.xml: R: is not a rotation matrix"]


def test_a_node_given_twice_is_refused() -> None:
    assert "more than once" in reasons(storage(camera_matrix(), camera_matrix()))[0]


def test_an_empty_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.xml").touch()
    with pytest.raises(FormatError, match="the file is empty"):
        read_intrinsic(tmp_path / "a.xml")


def test_a_file_that_is_not_xml_is_refused() -> None:
    assert "not XML" in reasons(b"RECTANGLE 0 0 notvisible")[0]


def test_entities_are_refused() -> None:
    bomb = b'<!DOCTYPE a [<!ENTITY b "1 2 3"><!ENTITY c "&b;&b;&b;">]><a><rvec>&c;</rvec></a>'
    assert "not XML that can be read" in reasons(bomb, parse_extrinsic)[0]


def test_a_document_type_is_told_in_words() -> None:
    (told,) = reasons(b'<!DOCTYPE name SYSTEM "x.dtd"><a/>', parse_extrinsic)
    assert told.endswith("not XML that can be read: it has a DTD or entities")


def test_external_entities_are_refused() -> None:
    data = b'<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/hostname">]><a><rvec>&b;</rvec></a>'
    assert "not XML that can be read" in reasons(data, parse_extrinsic)[0]


def test_yaml_problems_name_the_line() -> None:
    text = b"%YAML:1.0\n---\nK: [1, 2]\nrubbish\n"
    assert reasons(text, path="a.yml") == [
        "a.yml: line 4: not 'name: value' and not an item of a list: 'rubbish'"
    ]


@pytest.mark.parametrize(
    ("data", "path"),
    [
        (b"<a>" * 300_000, "a.xml"),
        (b"<a>" + b"<b>" * 100_000 + b"</b>" * 100_000 + b"</a>", "a.xml"),
        (b"<K>" + b"1" * 900_000 + b"x</K>", "a.xml"),
        (b"a" + b" " * 900_000, "a.yml"),
        (b"K: [" + b"1,\n" * 300_000, "a.yml"),
        (b"- " * 400_000, "a.yml"),
        (b"#" * 900_000, "a.yml"),
    ],
    ids=["unclosed", "deep", "long number", "spaces", "long list", "dashes", "comment"],
)
def test_files_made_to_exhaust_time_or_stack_are_refused(data: bytes, path: str) -> None:
    with pytest.raises(FormatError):
        parse_intrinsic(data, path)


# Writing

finite = st.floats(allow_nan=False, allow_infinity=False, width=64)
focal = st.floats(min_value=1e-3, max_value=1e6)
vectors = st.lists(finite, min_size=3, max_size=3).map(np.array)


@st.composite
def intrinsics(draw: st.DrawFn) -> Intrinsic:
    matrix = np.array([[draw(focal), 0, draw(finite)], [0, draw(focal), draw(finite)], [0, 0, 1]])
    count = draw(st.sampled_from(DISTORTION_COUNTS))
    return Intrinsic(matrix, np.array(draw(st.lists(finite, min_size=count, max_size=count))))


@given(intrinsics())
def test_intrinsics_come_back_bit_for_bit(lens: Intrinsic) -> None:
    again = parse_intrinsic(intrinsic_xml(lens), "a.xml")
    assert np.array_equal(again.matrix, lens.matrix)
    assert np.array_equal(again.distortion, lens.distortion)


@given(vectors, vectors)
def test_poses_come_back_bit_for_bit(rvec: np.ndarray, tvec: np.ndarray) -> None:
    pose = Extrinsic(rvec, tvec)
    for style in Style:
        again = parse_extrinsic(extrinsic_xml(pose, style), "a.xml")
        assert np.array_equal(again.rvec, rvec)
        assert np.array_equal(again.tvec, tvec)


LENS = Intrinsic(np.array(NUMBERS, float).reshape(3, 3), np.array([-0.4, 0.6, 8e-3, 1e-5, -0.7]))
POSE = Extrinsic(
    np.array([1.759099006652832, 0.46710100769996643, -0.331699013710022]), np.array([-5.25, 1e-20, 9.0])
)


def test_opencv_reads_written_intrinsics() -> None:
    theirs = file_storage(intrinsic_xml(LENS))
    assert np.array_equal(theirs.getNode("camera_matrix").mat(), LENS.matrix)
    assert np.array_equal(theirs.getNode("distortion_coefficients").mat().ravel(), LENS.distortion)


def test_opencv_reads_written_poses() -> None:
    theirs = file_storage(extrinsic_xml(POSE, Style.MATRIX))
    assert np.array_equal(theirs.getNode("rvec").mat().ravel(), POSE.rvec)
    assert np.array_equal(theirs.getNode("tvec").mat().ravel(), POSE.tvec)


def test_wildtrack_readers_split_the_text_of_a_written_pose() -> None:
    root = ElementTree.fromstring(extrinsic_xml(POSE, Style.TEXT))
    for name, values in [("rvec", POSE.rvec), ("tvec", POSE.tvec)]:
        text = root.findall(name)[0].text or ""
        assert [float(word) for word in text.lstrip().rstrip().split(" ")] == values.tolist()


@pytest.mark.parametrize(("unit", "factor"), [("m", 1), ("cm", 100), ("mm", 1000)])
def test_units_convert_both_ways(unit: str, factor: int) -> None:
    pose = Extrinsic(np.zeros(3), np.array([-3.0, 0.5, 12.0]) * factor)
    assert pose.in_metres(unit).tvec.tolist() == [-3.0, 0.5, 12.0]
    assert pose.in_metres(unit).in_unit(unit).tvec.tolist() == pose.tvec.tolist()


# Whatever bytes come

TAGS = b"<K> </K> <rvec> </rvec> <rows>3</rows> <data> </data> <!DOCTYPE_a> &amp; &x;".split()
WORDS = b'K: - -- [ ] 1 -2.5 nan data: rows: # " :'.split()
PIECES = st.sampled_from([*TAGS, *WORDS, b"\n", b"  ", b"\xff"])


@settings(max_examples=300)
@given(
    st.binary(max_size=200) | st.lists(PIECES, max_size=40).map(b"".join), st.sampled_from(["a.xml", "a.yml"])
)
def test_any_bytes_are_either_read_or_refused(data: bytes, path: str) -> None:
    for parse in (parse_intrinsic, parse_extrinsic):
        try:
            parse(data, path)
        except FormatError as error:
            assert error.problems
