"""Pictures with their lens taken out, file by file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.formats.files import make_folder, replacing
from gtm_hit.formats.problems import FormatError, Problem, ProblemList
from gtm_hit.geometry.camera import Floats, beyond_fold, undistort_maps
from gtm_hit.geometry.undistorting import kept_matrix, without_picture

SUFFIXES = {".png", ".jpg", ".jpeg"}
QUALITY = [cv2.IMWRITE_JPEG_QUALITY, 95]
NOWHERE = np.zeros(3)


@dataclass(frozen=True, eq=False)
class Undistorted:
    """What the new pictures are."""

    matrix: Floats  # (3, 3) pixels; they have no distortion
    black: int  # pixels of each picture that show nothing
    folded: int  # of these, those where the lens has no answer
    pictures: int


def pictures_in(path: Path) -> list[Path]:
    """The picture, or those of the folder by name. Raises FormatError where there is none."""
    if path.is_file():
        return [path]
    found = sorted(each for each in path.glob("*") if each.suffix.lower() in SUFFIXES and each.is_file())
    if not found:
        raise FormatError([Problem(str(path), "", "no PNG or JPEG there")])
    return found


def size_of(picture: Path) -> tuple[int, int]:
    """Width and height. Raises FormatError."""
    height, width = _read(picture).shape[:2]
    return width, height


def undistort(pictures: Sequence[Path], lens: Lens, out: Path, alpha: float | None) -> Iterator[Undistorted]:
    """Writes each under its own name into `out`, and tells after each what it is.

    Without `alpha` the camera matrix stays. Raises FormatError, before anything is written, for pictures of
    another size than the lens's, for two of the same name, and for an `out` that they lie in themselves.
    """
    _check(pictures, lens, out)
    camera = lens.camera("lens", NOWHERE, NOWHERE)
    matrix = camera.matrix if alpha is None else kept_matrix(camera, alpha)
    maps = undistort_maps(camera, matrix)
    black = int(without_picture(camera, matrix).sum())
    folded = int(beyond_fold(camera, matrix).sum())
    make_folder(out)
    for count, picture in enumerate(pictures, start=1):
        changed = cv2.remap(_read(picture), *maps, cv2.INTER_CUBIC)
        _write(out / picture.name, changed)
        yield Undistorted(matrix, black, folded, count)


def _check(pictures: Sequence[Path], lens: Lens, out: Path) -> None:
    problems = ProblemList(out)
    names = [picture.name for picture in pictures]
    for picture in pictures:
        if picture.parent.resolve() == out.resolve():
            problems.add("", "the pictures lie there themselves; choose another folder")
            break
    for name in sorted({name for name in names if names.count(name) > 1}):
        problems.add(name, "more than one picture has this name")
    for picture in pictures:
        if (size := size_of(picture)) != (lens.width, lens.height):
            told = f"{size[0]}×{size[1]} pixels, but the lens is for {lens.width}×{lens.height}"
            problems.add("", told, picture)
    problems.raise_if_any()


def _read(picture: Path) -> np.ndarray[Any, Any]:
    """As stored: grey stays grey, 16 bits stay 16 bits, and nothing is turned."""
    data = np.frombuffer(picture.read_bytes(), np.uint8)
    found = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if len(data) else None
    if found is None:
        raise FormatError([Problem(str(picture), "", "not a picture that can be read")])
    return found


def _write(target: Path, picture: np.ndarray[Any, Any]) -> None:
    is_png = target.suffix.lower() == ".png"
    _done, data = cv2.imencode(target.suffix, picture, [] if is_png else QUALITY)
    with replacing(target) as stream:
        stream.write(data.tobytes())
