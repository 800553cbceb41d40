"""Where the parts of a dataset lie in its folder, as WILDTRACK and MultiviewX publish theirs."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from gtm_hit.formats.calibration.files import CalibrationFiles, find_calibrations
from gtm_hit.formats.dataset_folder import DatasetFolder
from gtm_hit.formats.problems import ProblemList

IMAGE_FOLDERS = ("Image_subsets", "images")
IMAGE_SUFFIXES = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp"}
ANNOTATION_FOLDER = "annotations_positions"

_MULTIVIEWX_NAME = re.compile(r"Camera[0-9]+")


@dataclass(frozen=True)
class Layout:
    """The files of one dataset, by camera and by frame number.

    `cameras` are the names of the image folders in natural order, which is the order of `viewNum`.
    `annotations` is by the number of the frame they belong to, which is `annotation_offset` less than the
    number in the file name.
    """

    cameras: tuple[str, ...]
    images: Mapping[str, Mapping[int, Path]]
    calibrations: CalibrationFiles
    annotations: Mapping[int, Path]
    annotation_offset: int


def find_layout(
    root: Path,
    problems: ProblemList,
    images: Path | None = None,
    annotation_offset: int | None = None,
    calibrations: Path | None = None,
    annotations: Path | None = None,
) -> Layout:
    """The parts of the dataset in the folder `root`.

    `images` is the folder with a folder per camera or an image per camera, seen from `root`; without it the
    published names are looked for. `calibrations` and `annotations` name these folders likewise.
    `annotation_offset` None means 1 for MultiviewX, whose annotation 00001 belongs to image 0000, and 0 for
    everything else.

    Everything missing, surplus, ambiguous, or leading out of the folder is added to `problems`; the layout
    has what could be found.
    """
    dataset = DatasetFolder(root, problems)
    by_camera = _images(dataset, images)
    frames = _frames(by_camera, problems)
    files = find_calibrations(dataset, by_camera, calibrations) if by_camera else CalibrationFiles()
    if files.names and not files.intrinsic and not files.intrinsic_original:
        problems.add("", "no intrinsic files: none of intrinsic_zero, intrinsic, intrinsic_original")
    annotation_files = _annotations(dataset, annotations)
    if annotation_offset is None:
        annotation_offset = _published_offset(files.names.values(), frames, annotation_files)
    for number, path in annotation_files.items():
        if frames and number - annotation_offset not in frames:
            problems.add("", f"no images of frame {number - annotation_offset}", path)
    return Layout(
        cameras=tuple(by_camera),
        images=by_camera,
        calibrations=files,
        annotations={number - annotation_offset: path for number, path in annotation_files.items()},
        annotation_offset=annotation_offset,
    )


def _images(dataset: DatasetFolder, chosen: Path | None) -> dict[str, dict[int, Path]]:
    candidates = [dataset.root / name for name in (IMAGE_FOLDERS if chosen is None else [chosen])]
    folder = next((path for path in candidates if path.is_dir()), None)
    if folder is None:
        # Seen from the folder: only one path at the front is made shorter where a message goes out.
        others = (str(each.relative_to(dataset.root)) for each in candidates[1:])
        dataset.problems.add("", "no such folder of images", " or ".join([str(candidates[0]), *others]))
        return {}
    if chosen is not None and not folder.resolve().is_relative_to(dataset.root):
        # Whoever runs the import may keep images on another disk; what is in there may not lead further.
        dataset = DatasetFolder(folder, dataset.problems)
    folders = [path for path in dataset.entries(folder) if path.is_dir()]
    if folders:
        return {path.name: _images_of_camera(dataset, path) for path in folders}
    files = dataset.by_name(dataset.files(folder, IMAGE_SUFFIXES), lambda path: path.stem)
    if not files:
        dataset.problems.add("", "neither a folder per camera nor an image per camera", folder)
    return {name: {0: path} for name, path in files.items()}


def _images_of_camera(dataset: DatasetFolder, folder: Path) -> dict[int, Path]:
    found = dataset.by_number(folder, IMAGE_SUFFIXES)
    if not found:
        dataset.problems.add("", "no images in this folder", folder)
    return found


def _annotations(dataset: DatasetFolder, chosen: Path | None) -> dict[int, Path]:
    folder = dataset.root / (chosen or ANNOTATION_FOLDER)
    if chosen is not None:
        dataset = dataset.at(folder)
    if folder.is_dir():
        return dataset.by_number(folder, {".json"})
    if chosen is not None:
        dataset.problems.add("", "no such folder of annotations", folder)
    return {}


def _frames(by_camera: Mapping[str, Mapping[int, Path]], problems: ProblemList) -> set[int]:
    """All frame numbers; every camera is expected to have each of them."""
    frames: set[int] = set().union(*by_camera.values())
    for camera, images in by_camera.items():
        missing = sorted(frames - images.keys())
        if images and missing:
            first = ", ".join(map(str, missing[:5])) + (", ..." if len(missing) > 5 else "")
            problems.add(f"camera {camera}", f"no image of {len(missing)} frames other cameras have: {first}")
    return frames


def _published_offset(names: Collection[str], frames: set[int], annotations: Mapping[int, Path]) -> int:
    published = bool(names) and all(_MULTIVIEWX_NAME.fullmatch(name) for name in names)
    return int(published and min(frames) == 0 and min(annotations, default=0) == 1)
