"""Photographs of real boards, and rendered ones that fail in the same ways.

FOLDER holds `chessboard_opencv_left`, `pose2sim_chessboard`, `charuco_4x5_masked`, `acircles_photos`. What is
not there gets a row that says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from benchmarks.calibration_rows import Bar, Row, absent, told
from gtm_hit.calibration.artwork import extent
from gtm_hit.calibration.boards import Board, BoardKind
from gtm_hit.calibration.intrinsics import LensSolution, solve_lens
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.searching import Searched, search
from gtm_hit.calibration.sources import decoded
from gtm_hit.calibration.verdict import Word, judge, worst_view
from gtm_hit.calibration.views import NotFound, Picture
from gtm_hit.demo.boards import Placement, board_picture

LEFT = Board(BoardKind.CHESSBOARD, 9, 6, 0.03)
PORTRAIT = Board(BoardKind.CHESSBOARD, 4, 7, 0.06)
MASKED = Board(BoardKind.CHARUCO, 4, 5, 0.054, 0.75, "DICT_4X4_1000", inverted=True)
CIRCLES = Board(BoardKind.ACIRCLES, 4, 11, 0.03)

LEFT_FOUND, LEFT_RMS = Bar("left*.jpg: found", "13 of 13"), Bar("left*.jpg: RMS", "≤ 0.20 px")
LEFT_FOCAL, LEFT_VERDICT = Bar("left*.jpg: fx", "532.8 ± 1"), Bar("left*.jpg: verdict")
PORTRAIT_FOUND, PORTRAIT_RMS = Bar("pose2sim cam04: found", "6 of 7"), Bar("pose2sim cam04: RMS", "≤ 0.93 px")
PORTRAIT_REST = Bar("pose2sim cam04: RMS without the view it names", "≤ 0.22 px")
MASKED_RMS, MASKED_VERDICT = Bar("ChArUco cam0: RMS", "≤ 0.20 px"), Bar("ChArUco cam0: verdict")
FEW_VERDICT = Bar("ChArUco cam3, of which too little was seen: verdict", "not good")
CIRCLES_RMS = Bar("circle photographs: RMS")
CIRCLES_VERDICT = Bar("circle photographs: verdict", Word.DO_NOT_USE.value)

ONE_SIDED = Lens(
    640, 480, np.array([[3150.0, 0, 330], [0, 3150, 250], [0, 0, 1]]), np.array([-0.3, 0, 0, 0, 0])
)
LEANS = np.radians((10, 34))  # all to the same side, as on the photographs
UNEVEN = 0.34  # pixels along each axis that paper which is not flat puts circles elsewhere


def real(data: Path) -> Iterator[Row]:
    yield from left_photographs(data / "chessboard_opencv_left")
    yield from portraits(data / "pose2sim_chessboard")
    yield from masked(data / "charuco_4x5_masked")
    yield from too_few(data / "charuco_4x5_masked")
    yield from circle_photographs(data / "acircles_photos")


def folder_search(folder: Path, pattern: str, board: Board) -> tuple[Searched, tuple[int, int]] | None:
    read: list[Picture | NotFound] = [
        decoded(file.name, file.read_bytes()) for file in sorted(folder.glob(pattern))
    ]
    sizes = {each.size for each in read if isinstance(each, Picture)}
    return (search(read, board), sizes.pop()) if len(sizes) == 1 else None


def left_photographs(folder: Path) -> Iterator[Row]:
    found = folder_search(folder, "*.jpg", LEFT)
    if found is None:
        yield from absent((LEFT_FOUND, LEFT_RMS, LEFT_FOCAL, LEFT_VERDICT), told(folder))
        return
    solution = solve_lens(found[0].views, found[1])
    count, focal = len(found[0].views), solution.parameters["fx"]
    yield LEFT_FOUND.row(f"{count} of 13", count == 13)
    yield LEFT_RMS.row(f"{solution.rms:.3f} px", solution.rms <= 0.20)
    yield LEFT_FOCAL.row(f"{focal:.2f} ± {solution.sigma['fx']:.2f}", abs(focal - 532.8) <= 1)
    yield LEFT_VERDICT.row(judge(solution).word.value)


def portraits(folder: Path) -> Iterator[Row]:
    found = folder_search(folder, "cam04*.jpg", PORTRAIT)
    if found is None:
        yield from absent((PORTRAIT_FOUND, PORTRAIT_RMS, PORTRAIT_REST), told(folder))
        return
    views, size = found[0].views, found[1]
    solution = solve_lens(views, size)
    worst = worst_view(solution).name
    rest = solve_lens([view for view in views if view.name != worst], size)
    yield PORTRAIT_FOUND.row(f"{len(views)} of 7", len(views) == 6)
    yield PORTRAIT_RMS.row(f"{solution.rms:.3f} px", solution.rms <= 0.93)
    yield PORTRAIT_REST.row(f"{rest.rms:.3f} px ({worst})", rest.rms <= 0.22)


def masked(folder: Path) -> Iterator[Row]:
    found = folder_search(folder, "cam0*.png", MASKED)
    if found is None:
        yield from absent((MASKED_RMS, MASKED_VERDICT), told(folder / "cam0*.png"))
        return
    solution = solve_lens(found[0].views, found[1])
    yield MASKED_RMS.row(f"{solution.rms:.3f} px", solution.rms <= 0.20)
    yield MASKED_VERDICT.row(judge(solution).word.value)


def too_few(folder: Path) -> Iterator[Row]:
    found = folder_search(folder, "cam3*.png", MASKED)
    if found is None:
        yield from absent((FEW_VERDICT,), told(folder / "cam3*.png"))
        return
    word = judge(solve_lens(found[0].views, found[1])).word
    yield FEW_VERDICT.row(word.value, word is not Word.GOOD)


def circle_photographs(folder: Path) -> Iterator[Row]:
    found = folder_search(folder, "*.png", CIRCLES)
    if found is None:
        yield from absent((CIRCLES_RMS, CIRCLES_VERDICT), told(folder))
        return
    yield from _from_one_side(solve_lens(found[0].views, found[1]), CIRCLES_RMS, CIRCLES_VERDICT)


def _from_one_side(solution: LensSolution, rms: Bar, verdict: Bar) -> Iterator[Row]:
    word = judge(solution).word
    yield rms.row(f"{solution.rms:.3f} px")
    yield verdict.row(word.value, word is Word.DO_NOT_USE)


def sheared_view(pictures: Sequence[Picture], board: Board, place: int = 4) -> Iterator[Row]:
    """Of rendered pictures one is sheared by 2 %, as a rolling shutter does with a board that moves."""
    shear = np.array([[1.0, 0.02, 0.0], [0.0, 1.0, 0.0]])
    spoilt, bad = list(pictures), pictures[place]
    bent = cv2.warpAffine(bad.grey, shear, bad.size, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    spoilt[place] = Picture(bad.name, np.asarray(bent, np.uint8))
    views = search(spoilt, board).views
    solution = solve_lens(views, bad.size)
    worst = worst_view(solution).name
    rest = solve_lens([view for view in views if view.name != worst], bad.size)
    name = f"rendered {board.kind}, one view sheared"
    yield Row(f"{name}: RMS", f"{solution.rms:.3f} px", "", None)
    yield Row(f"{name}: named", worst, bad.name, worst == bad.name)
    yield Row(f"{name}: RMS without it", f"{rest.rms:.3f} px", "≤ 0.06 px", rest.rms <= 0.06)


def one_sided_circles(count: int = 10) -> Iterator[Row]:
    """Rendered as the photographs are: a long lens, a board that leans to one side and is not quite flat."""
    rng = np.random.default_rng(5)
    area = extent(CIRCLES)
    middle = np.array([(area.left + area.right) / 2, (area.top + area.bottom) / 2, 0.0])
    pictures = []
    for number in range(count):
        rvec = np.array([0.0, rng.uniform(*LEANS), 0.0])
        turn = cv2.Rodrigues(rvec)[0]
        # The board fills half of the picture's height, somewhere in it.
        depth = ONE_SIDED.matrix[0, 0] * (area.bottom - area.top) / 240
        pixel = rng.uniform((0.3, 0.35), (0.7, 0.65)) * (ONE_SIDED.width, ONE_SIDED.height)
        ray = (pixel - ONE_SIDED.matrix[:2, 2]) / ONE_SIDED.matrix[[0, 1], [0, 1]]
        placement = Placement(rvec, depth * np.array([*ray, 1.0]) - turn @ middle)
        grey = board_picture(ONE_SIDED, CIRCLES, placement, noise=4.0, seed=number)
        pictures.append(Picture(f"{number:02d}", grey))
    views = [
        replace(view, pixels=view.pixels + rng.normal(0, UNEVEN, view.pixels.shape))
        for view in search(pictures, CIRCLES).views
    ]
    name = f"rendered acircles, {len(views)} of {count} found, all from one side"
    bars = Bar(f"{name}: RMS"), Bar(f"{name}: verdict", Word.DO_NOT_USE.value)
    yield from _from_one_side(solve_lens(views, (ONE_SIDED.width, ONE_SIDED.height)), *bars)
