"""A calibration that is to replace a dataset's."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from django.conf import settings
from django.core.files.uploadedfile import UploadedFile

from gtm_hit.formats.calibration.files import CAMERAS_JSON, CalibrationFiles, find_calibrations
from gtm_hit.formats.dataset_folder import DatasetFolder
from gtm_hit.formats.files import write_bytes
from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Dataset
from gtm_hit.ops.calibration.cameras import read_views, tell_wrong_unit
from gtm_hit.ops.files import sources

MOST_BYTES = 10_000_000  # of an upload


def read_replacement(dataset: Dataset, path: Path, unit: str = "m") -> list[Camera]:
    """The cameras of a `cameras.json`, or of a folder like `calibrations/` or one that holds that.

    They are those of the dataset by name and size. Raises FormatError with everything that is wrong, its
    paths seen from `path`.
    """
    problems = ProblemList(path)
    names = list(dataset.cameras.values_list("name", flat=True))
    sizes = {
        name: (width, height)
        for name, width, height in dataset.cameras.values_list("name", "width", "height")
    }
    files = _files(path, names, problems)
    views = read_views(files, names, sizes, unit, undistort=False, problems=problems)
    cameras = [view.camera for view in views]
    for camera in cameras:
        if dataset.undistorted and camera.has_lens:
            problems.add(
                f"camera {camera.name}",
                "has lens distortion, but the lens was taken out of this dataset's images: "
                "give the calibration of undistorted images",
            )
    if len(cameras) == len(names):
        tell_wrong_unit(cameras, dataset.grid, unit, problems)
    problems.raise_if_any()
    return cameras


def file_report(name: str, data: Iterable[bytes], unit: str) -> dict[str, Any]:
    """Of a version that came as a file: its name, its content's digest, and what it was read as."""
    digest = hashlib.sha256()
    for chunk in data:
        digest.update(chunk)
    json_too = name.lower().endswith(".json")  # always in metres, whatever was said
    return {"file": {"name": name, "sha256": digest.hexdigest(), "unit": "m" if json_too else unit}}


def read_upload(dataset: Dataset, file: UploadedFile, unit: str = "m") -> list[Camera]:
    """The cameras of an uploaded `cameras.json`, or zip of a folder; paths in a FormatError seen from it."""
    settings.UPLOADS_ROOT.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix=".calibration-", dir=settings.UPLOADS_ROOT) as name:
        folder = Path(name)
        try:
            return read_replacement(dataset, _unpacked(folder, file), unit)
        except FormatError as error:
            raise error.relative_to(folder) from error


def _unpacked(folder: Path, file: UploadedFile) -> Path:
    if (file.name or "").lower().endswith(".json"):
        path = folder / CAMERAS_JSON
        write_bytes(path, file.read())
        return path
    archive, path = folder / "calibration.zip", folder / "calibration"
    write_bytes(archive, file.read())
    sources.unpack(archive, path, lambda _done, _total: None)
    return sources.dataset_folder(path)


def _files(path: Path, names: list[str], problems: ProblemList) -> CalibrationFiles:
    inner = path / "calibrations"
    if path.is_dir() and inner.is_dir() and not (path / CAMERAS_JSON).exists():
        path = inner
    return find_calibrations(DatasetFolder(path.parent, problems), names, Path(path.name))
