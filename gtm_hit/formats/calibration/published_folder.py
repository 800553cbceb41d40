"""A folder of cameras as WILDTRACK lays it out, read and written without a dataset around it.

    extrinsic/extr_NAME.xml            rvec and tvec; a comment says in which unit tvec is
    intrinsic_zero/intr_NAME.xml       camera matrix of undistorted images, no distortion
    intrinsic_original/intr_NAME.xml   camera matrix and distortion of images as they were taken

The size of the pictures is in none of the files.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from gtm_hit.formats.calibration.files import CALIBRATION_FOLDER, CALIBRATION_SUFFIXES
from gtm_hit.formats.calibration.wildtrack_xml import (
    Extrinsic,
    Intrinsic,
    Style,
    extrinsic_xml,
    intrinsic_xml,
    parse_extrinsic,
    read_intrinsic,
)
from gtm_hit.formats.dataset_folder import DatasetFolder
from gtm_hit.formats.files import read_source
from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.geometry.camera import CalibrationError, Camera

MOST_BYTES = 1_000_000
_UNIT = re.compile(rb"<!-- tvec in (m|cm|mm) -->")


def read_folder(path: Path, size: tuple[int, int], unit: str | None = None) -> list[Camera]:
    """The cameras of the pictures as taken, width and height being `size`, in natural order of their names.

    `unit` is needed where the files do not say theirs. FormatError with everything that is wrong.
    """
    problems = ProblemList(path)
    folder = path / CALIBRATION_FOLDER if (path / CALIBRATION_FOLDER).is_dir() else path
    cameras = []
    for index, pose in enumerate(_poses(folder, problems)):
        name = pose.stem.removeprefix("extr_")
        try:
            extrinsic = _extrinsic(pose, unit)
            lens = read_intrinsic(_lens_path(folder, name, pose.suffix))
            pose_numbers = (extrinsic.rvec, extrinsic.tvec)
            cameras.append(
                Camera(index, name, *size, lens.matrix, *pose_numbers, lens.distortion, lens.model)
            )
        except FormatError as error:
            problems.extend(error.problems)
        except CalibrationError as error:
            problems.add("", str(error), pose)
    problems.raise_if_any()
    return cameras


def folder_files(cameras: Sequence[Camera], unit: str) -> Iterator[tuple[str, bytes]]:
    """Names and bytes of the files, for `read_folder` and for the readers of WILDTRACK."""
    for camera in cameras:
        pose = extrinsic_xml(Extrinsic(camera.rvec, camera.tvec).in_unit(unit), Style.TEXT)
        note = f"<!-- tvec in {unit} -->\n</opencv_storage>".encode()
        yield f"extrinsic/extr_{camera.name}.xml", pose.replace(b"</opencv_storage>", note)
        lens = Intrinsic(camera.matrix, camera.distortion, camera.model)
        yield f"intrinsic_original/intr_{camera.name}.xml", intrinsic_xml(lens)
        plain = Intrinsic(camera.matrix, np.zeros(5))
        yield f"intrinsic_zero/intr_{camera.name}.xml", intrinsic_xml(plain)


def _poses(folder: Path, problems: ProblemList) -> list[Path]:
    found = DatasetFolder(folder, problems).files(folder.resolve() / "extrinsic", CALIBRATION_SUFFIXES)
    if not found and not problems:
        problems.add("", "no files in a folder extrinsic")
    return found


def _lens_path(folder: Path, name: str, suffix: str) -> Path:
    """Of the pictures as taken, unless the folder has only those of undistorted ones."""
    places = [folder / part / f"intr_{name}{suffix}" for part in ("intrinsic_original", "intrinsic_zero")]
    return next((place for place in places if place.exists()), places[0])


def _extrinsic(path: Path, unit: str | None) -> Extrinsic:
    problems = ProblemList(path)
    data = read_source(path, MOST_BYTES)
    match = _UNIT.search(data)
    said = match[1].decode() if match else None
    if said and unit and said != unit:
        problems.add("", f"says that tvec is in {said}, not in {unit}")
    if not (said or unit):
        problems.add("", "does not say in which unit tvec is: give it")
    problems.raise_if_any()
    return parse_extrinsic(data, str(path)).in_metres(said or unit or "m")
