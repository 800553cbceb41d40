"""Which calibration file belongs to which camera."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from gtm_hit.formats.dataset_folder import DatasetFolder

CALIBRATION_FOLDER = "calibrations"
CALIBRATION_SUFFIXES = {".xml", ".yml", ".yaml"}
CAMERAS_JSON = "cameras.json"

_PREFIX = re.compile(r"^(extr|intr)(?:insics?)?[_-]", re.IGNORECASE)
_NUMBER = re.compile(r"([0-9]{1,18})$")


@dataclass(frozen=True)
class CalibrationFiles:
    """Files by camera, `names` being what the files call the cameras (CVLab1 for WILDTRACK's C1).

    `intrinsic` belongs to images without lens distortion or with little (MultiviewX), `intrinsic_original` to
    images as the cameras took them; one of the two may be empty.
    Or `cameras_json` alone, which holds all cameras under names of its own.
    """

    names: Mapping[str, str] = field(default_factory=dict)
    extrinsic: Mapping[str, Path] = field(default_factory=dict)
    intrinsic: Mapping[str, Path] = field(default_factory=dict)
    intrinsic_original: Mapping[str, Path] = field(default_factory=dict)
    cameras_json: Path | None = None


def find_calibrations(
    dataset: DatasetFolder, cameras: Collection[str], chosen: Path | None = None
) -> CalibrationFiles:
    """The files in `calibrations/`: one folder per part, or all in one where a file may hold both parts, or
    a `cameras.json` (see `camera_json`).

    `chosen` is another folder of that kind, or a file of the last, seen from the dataset's folder.
    """
    folder = dataset.root / (chosen or CALIBRATION_FOLDER)
    if folder.is_file() and folder.suffix.lower() == ".json":
        return CalibrationFiles(cameras_json=folder)
    if not folder.is_dir():
        dataset.problems.add("", f"no folder {chosen or CALIBRATION_FOLDER}", dataset.root)
        return CalibrationFiles()
    if chosen is not None:
        dataset = dataset.at(folder)
    if (folder / CAMERAS_JSON).is_file():
        return _json_alone(dataset, folder)
    extrinsic_folder, intrinsic_folder = folder / "extrinsic", folder / "intrinsic_zero"
    if not extrinsic_folder.is_dir():
        extrinsic_folder = intrinsic_folder = folder
    elif not intrinsic_folder.is_dir():
        intrinsic_folder = folder / "intrinsic"
    extrinsic = _files(dataset, extrinsic_folder, "extr")
    names = match_names(cameras, extrinsic)
    _tell_differences(dataset, extrinsic_folder, cameras, names, extrinsic)
    return CalibrationFiles(
        names,
        {camera: extrinsic[name] for camera, name in names.items()},
        _of_cameras(dataset, intrinsic_folder, names),
        _of_cameras(dataset, folder / "intrinsic_original", names),
    )


def match_names(cameras: Collection[str], names: Collection[str]) -> dict[str, str]:
    """Camera to calibration name: by equal names, else by equal numbers at their ends, else by order.

    Order decides only between equally many whose numbers run in step: nothing missing may shift all others.
    """
    same = {name.casefold(): name for name in names}
    if any(camera.casefold() in same for camera in cameras):
        return {camera: same[camera.casefold()] for camera in cameras if camera.casefold() in same}
    camera_numbers, name_numbers = _numbers(cameras), _numbers(names)
    shifts = {theirs - ours for ours, theirs in zip(camera_numbers, name_numbers, strict=False)}
    if len(cameras) == len(names) and len(shifts) < 2:
        return dict(zip(cameras, names, strict=True))
    return {
        camera_numbers[number]: name_numbers[number] for number in camera_numbers if number in name_numbers
    }


def _json_alone(dataset: DatasetFolder, folder: Path) -> CalibrationFiles:
    found = {path.name: path for path in dataset.entries(folder)}
    for path in found.values():
        if path.is_dir() or path.suffix.lower() in CALIBRATION_SUFFIXES:
            dataset.problems.add("", f"lies beside {CAMERAS_JSON}: keep one of the two calibrations", path)
    return CalibrationFiles(cameras_json=found.get(CAMERAS_JSON))


def _numbers(names: Collection[str]) -> dict[int, str]:
    """Names by the numbers at their ends; none when they do not tell the names apart."""
    found = {int(match[1]): name for name in names if (match := _NUMBER.search(name))}
    return found if len(found) == len(names) else {}


def _files(dataset: DatasetFolder, folder: Path, part: str) -> dict[str, Path]:
    if not folder.is_dir():
        return {}
    paths = dataset.files(folder, CALIBRATION_SUFFIXES)
    fitting = [path for path in paths if not (match := _PREFIX.match(path.stem)) or match[1].lower() == part]
    return dataset.by_name(fitting, lambda path: _PREFIX.sub("", path.stem))


def _of_cameras(dataset: DatasetFolder, folder: Path, names: Mapping[str, str]) -> dict[str, Path]:
    files = _files(dataset, folder, "intr")
    if not files:
        return {}
    found = {camera: files[name] for camera, name in names.items() if name in files}
    for camera in names.keys() - found.keys():
        dataset.problems.add("", f"no file for camera {camera} ({names[camera]})", folder)
    for name in files.keys() - set(names.values()):
        dataset.problems.add("", "belongs to no camera that has a pose", files[name])
    return found


def _tell_differences(
    dataset: DatasetFolder,
    folder: Path,
    cameras: Collection[str],
    names: Mapping[str, str],
    extrinsic: Mapping[str, Path],
) -> None:
    if not extrinsic:
        dataset.problems.add("", "no extrinsic files", folder)
        return
    for camera in cameras:
        if camera not in names:
            dataset.problems.add("", f"no file for camera {camera}", folder)
    for name, path in extrinsic.items():
        if name not in names.values():
            dataset.problems.add("", "belongs to no camera that has images", path)
