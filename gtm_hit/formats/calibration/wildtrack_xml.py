"""Calibration of one camera in OpenCV's XML or YAML: an intrinsic and an extrinsic file, or one with both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import cv2
import numpy as np

from gtm_hit.formats.calibration.opencv_storage import StoredNode, parse_storage
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import ProblemList, shown
from gtm_hit.geometry.camera import CameraModel

MOST_BYTES = 1_000_000
DISTORTION_COUNTS = (4, 5, 8, 12, 14)
FISHEYE_COUNTS = (4,)

# Names used in the field, compared without case and separators; the first one present wins.
MATRIX_NAMES = ("cameramatrix", "k", "intrinsicmatrix", "intrinsics", "intrinsic", "mtx", "cameramat")
DISTORTION_NAMES = (
    "distortioncoefficients",
    "distcoeffs",
    "distortioncoeffs",
    "distcoefs",
    "distortion",
    "dist",
    "d",
)
RVEC_NAMES = ("rvec", "rotationvector", "rvecs")
ROTATION_NAMES = ("r", "rotationmatrix", "rotation", "rot", "rmat")
FISHEYE_FLAGS = ("fisheyemodel", "usefisheye")  # as OpenCV's calibration program writes it: 1
MODEL_NAMES = ("model", "cameramodel", "distortionmodel", "projectionmodel")
FISHEYE_WORDS = ("fisheye", "equidistant")  # cv2.fisheye's model, and ROS's name for the same
TVEC_NAMES = ("tvec", "translationvector", "translation", "t", "tvecs")

_METRE = {"m": 1.0, "cm": 100.0, "mm": 1000.0}


class Style(StrEnum):
    """How numbers stand in a file: `text` as in WILDTRACK's poses, `matrix` as OpenCV writes them."""

    TEXT = "text"
    MATRIX = "matrix"


@dataclass(frozen=True, eq=False)
class Intrinsic:
    """Camera matrix and lens of one camera.

    matrix : (3, 3) float64, pixels
    distortion : (k,) float64 with k = 4, 5, 8, 12 or 14, in OpenCV's order; zeros when the file has none
    model : a fisheye has k = 4
    """

    matrix: np.ndarray
    distortion: np.ndarray
    model: CameraModel = CameraModel.PINHOLE


@dataclass(frozen=True, eq=False)
class Extrinsic:
    """rvec : (3,) float64, radians. tvec : (3,) float64 in the unit of the file. World to camera."""

    rvec: np.ndarray
    tvec: np.ndarray

    def in_metres(self, tvec_unit: str) -> Extrinsic:
        """The same pose, its `tvec` being given in "m", "cm" or "mm"."""
        return Extrinsic(self.rvec, self.tvec / _METRE[tvec_unit])

    def in_unit(self, tvec_unit: str) -> Extrinsic:
        """The inverse of `in_metres`: from metres to "m", "cm" or "mm"."""
        return Extrinsic(self.rvec, self.tvec * _METRE[tvec_unit])


def read_intrinsic(path: Path) -> Intrinsic:
    """Raises FormatError, as `parse_intrinsic`."""
    return parse_intrinsic(read_source(path, MOST_BYTES), str(path))


def read_extrinsic(path: Path) -> Extrinsic:
    """Raises FormatError, as `parse_extrinsic`."""
    return parse_extrinsic(read_source(path, MOST_BYTES), str(path))


def parse_intrinsic(data: bytes, path: str) -> Intrinsic:
    """Camera matrix and distortion of an XML or YAML file; `path` is what problems are reported under.

    Raises FormatError: no camera matrix, wrong count, not a number, not finite, singular or skewed.
    """
    nodes = parse_storage(data, path)
    problems = ProblemList(path)
    model = _model(nodes)
    matrix = _required(nodes, MATRIX_NAMES, "camera_matrix", 9, problems).reshape(3, 3)
    if not problems:
        _check_matrix(matrix, problems)
    distortion = _distortion(nodes, model, problems)
    problems.raise_if_any()
    return Intrinsic(matrix, distortion, model)


def parse_extrinsic(data: bytes, path: str) -> Extrinsic:
    """Pose of an XML or YAML file, the rotation being a vector or a 3 x 3 matrix.

    Raises FormatError: node missing, wrong count, not a number, not finite, or not a rotation.
    """
    nodes = parse_storage(data, path)
    problems = ProblemList(path)
    rvec = _rotation_vector(nodes, problems)
    tvec = _required(nodes, TVEC_NAMES, "tvec", 3, problems)
    problems.raise_if_any()
    return Extrinsic(rvec, tvec)


def intrinsic_xml(intrinsic: Intrinsic) -> bytes:
    """An intrinsic file as WILDTRACK and MultiviewX publish it, read by cv2.FileStorage."""
    return _xml(
        *_fisheye_flag(intrinsic),
        ("camera_matrix", np.reshape(intrinsic.matrix, (3, 3)), Style.MATRIX),
        ("distortion_coefficients", np.reshape(intrinsic.distortion, (-1, 1)), Style.MATRIX),
    )


def _fisheye_flag(intrinsic: Intrinsic) -> list[tuple[str, np.ndarray, Style]]:
    """What OpenCV's own calibration program writes and reads."""
    return [("fisheye_model", np.array([1]), Style.TEXT)] if intrinsic.model is CameraModel.FISHEYE else []


def extrinsic_xml(extrinsic: Extrinsic, style: Style) -> bytes:
    """An extrinsic file.

    `Style.TEXT` is what WILDTRACK's readers take (they split the text of the node at single spaces),
    `Style.MATRIX` what MultiviewX's readers and cv2.FileStorage take. No file satisfies both.
    """
    return _xml(
        ("rvec", np.reshape(extrinsic.rvec, (3, 1)), style),
        ("tvec", np.reshape(extrinsic.tvec, (3, 1)), style),
    )


def _find(nodes: Sequence[StoredNode], names: Sequence[str], problems: ProblemList) -> StoredNode | None:
    for name in names:
        found = [node for node in nodes if _plain(node.name) == name]
        if not found:
            continue
        depth = min(node.depth for node in found)
        first, *others = [node for node in found if node.depth == depth]
        if others:
            problems.add(others[0].place, f"{shown(others[0].name)} is given more than once")
        return first
    return None


def _plain(name: str) -> str:
    return name.replace("_", "").replace("-", "").replace(" ", "").lower()


def _required(
    nodes: Sequence[StoredNode], names: Sequence[str], usual: str, count: int, problems: ProblemList
) -> np.ndarray:
    """(count,) array; NaN where the file gives no number, which `problems` then tells."""
    node = _find(nodes, names, problems)
    if node is None:
        problems.add("", f"no {usual} in this file")
        return np.full(count, np.nan)
    return _values(node, (count,), problems)


def _values(node: StoredNode, counts: Sequence[int], problems: ProblemList) -> np.ndarray:
    values = node.numbers(problems)
    if len(values) in counts:
        return np.array(values, dtype=np.float64)
    problems.add(node.place, f"{len(values)} numbers where {' or '.join(map(str, counts))} are expected")
    return np.full(counts[0], np.nan)


def _check_matrix(matrix: np.ndarray, problems: ProblemList) -> None:
    if not np.array_equal(matrix[2], [0, 0, 1]):
        problems.add("camera_matrix", f"its last row is {shown(matrix[2].tolist())} instead of 0 0 1")
    if matrix[0, 0] <= 0 or matrix[1, 1] <= 0:
        problems.add(
            "camera_matrix", f"focal lengths {matrix[0, 0]} and {matrix[1, 1]} are not both positive"
        )
    elif max(abs(matrix[0, 1]), abs(matrix[1, 0])) > 1e-6 * matrix[0, 0]:
        # OpenCV's projection ignores skew, so every rectangle would be silently wrong.
        problems.add("camera_matrix", "has skew, which OpenCV's camera model does not have")


def _model(nodes: Sequence[StoredNode]) -> CameraModel:
    # A fisheye's four coefficients mean something else than k1 k2 p1 p2: the file has to say what they are.
    quiet = ProblemList("")
    flag, name = _find(nodes, FISHEYE_FLAGS, quiet), _find(nodes, MODEL_NAMES, quiet)
    flagged = flag is not None and " ".join(flag.text).strip().lower() not in ("", "0", "false")
    named = name is not None and any(word in " ".join(name.text).lower() for word in FISHEYE_WORDS)
    return CameraModel.FISHEYE if flagged or named else CameraModel.PINHOLE


def _distortion(nodes: Sequence[StoredNode], model: CameraModel, problems: ProblemList) -> np.ndarray:
    counts = FISHEYE_COUNTS if model is CameraModel.FISHEYE else DISTORTION_COUNTS
    node = _find(nodes, DISTORTION_NAMES, problems)
    if node is None or not " ".join(node.text).strip("[] \t\r\n"):
        return np.zeros(4 if model is CameraModel.FISHEYE else 5)
    return _values(node, counts, problems)


def _rotation_vector(nodes: Sequence[StoredNode], problems: ProblemList) -> np.ndarray:
    node = _find(nodes, RVEC_NAMES, problems)
    if node is not None:
        return _values(node, (3,), problems)
    node = _find(nodes, ROTATION_NAMES, problems)
    if node is None:
        problems.add("", "no rvec and no rotation matrix in this file")
        return np.full(3, np.nan)
    values = _values(node, (9, 3), problems)
    if values.size == 3 or not np.isfinite(values).all():
        return values[:3]
    matrix = values.reshape(3, 3)
    # 1e-3 lets pass what was printed with few digits and nothing that is scaled, sheared or mirrored.
    if (
        np.abs(matrix).max() > 2
        or np.abs(matrix @ matrix.T - np.eye(3)).max() > 1e-3
        or np.linalg.det(matrix) < 0
    ):
        problems.add(node.place, "is not a rotation matrix")
        return np.full(3, np.nan)
    return cv2.Rodrigues(matrix)[0].ravel()


def _xml(*nodes: tuple[str, np.ndarray, Style]) -> bytes:
    parts = ['<?xml version="1.0"?>\n<opencv_storage>\n']
    for name, values, style in nodes:
        text = " ".join(map(repr, values.ravel().tolist()))
        if style is Style.TEXT:
            parts.append(f"<{name}>{text}</{name}>\n")
        else:
            rows, cols = values.shape
            parts.append(
                f'<{name} type_id="opencv-matrix">\n  <rows>{rows}</rows>\n  <cols>{cols}</cols>\n'
                f"  <dt>d</dt>\n  <data>\n    {text}</data></{name}>\n"
            )
    return "".join([*parts, "</opencv_storage>\n"]).encode()
