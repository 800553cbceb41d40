"""From views of a board to a camera's lens, with what is known about how good it is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import cv2
import numpy as np

from gtm_hit.calibration.lens_models import NAMES, LensModel
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.calibration.lens_refinement import Refined, refine
from gtm_hit.calibration.views import BoardView, Floats
from gtm_hit.geometry.errors import GeometryError
from gtm_hit.geometry.lens import distort, limit

FEWEST_VIEWS = 3
FOLDS = 5  # groups of views that are held out in turn
WORST = 50.0  # pixels RMS: more is no solution, whatever OpenCV calls it
STOP = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 100, 1e-9)


class LensError(GeometryError):
    """Views no lens can be told from; says why."""


@dataclass(frozen=True, eq=False)
class SolvedView:
    """A view, where the board was, and how far its points land from where they were seen."""

    view: BoardView
    rvec: Floats  # (3,) board to camera
    tvec: Floats  # (3,) metres, board to camera
    residuals: Floats  # (N, 2) pixels, seen minus computed

    @property
    def name(self) -> str:
        return self.view.name

    @property
    def rms(self) -> float:
        return _rms([self.residuals])


@dataclass(frozen=True, eq=False)
class LensSolution:
    lens: Lens
    model: LensModel
    sigma: dict[str, float]  # one standard deviation of every solved parameter, under `NAMES`
    rms: float  # pixels
    holdout_rms: float | None  # pixels, of views the lens was solved without; None: too few views
    views: tuple[SolvedView, ...]

    @property
    def parameters(self) -> dict[str, float]:
        (fx, _, cx), (_, fy, cy), _ = self.lens.matrix.tolist()
        numbers = (fx, fy, cx, cy, *self.lens.distortion.tolist())
        return dict(zip(NAMES, numbers, strict=False))

    @property
    def fold_radius(self) -> float:
        """Tangent of the angle off the axis beyond which the lens folds back; infinite for a sane one."""
        return limit(self.lens.distortion)

    @property
    def reach(self) -> float:
        """How far from the axis in the picture the lens lets anything land, as a share of the farthest
        corner's distance: below 1 it folds inside the picture. At most a sane lens's: infinite."""
        return fold_reach(self.lens)


def fold_reach(lens: Lens) -> float:
    """`LensSolution.reach` of any lens, along the radius that the radial part alone gives."""
    (fx, _, cx), (_, fy, cy), _ = lens.matrix.tolist()
    corner = np.hypot(max(cx, lens.width - 1 - cx) / fx, max(cy, lens.height - 1 - cy) / fy)
    fold = limit(lens.distortion)
    if np.isinf(fold):
        return float(np.inf)
    radial_only = lens.distortion.copy()
    radial_only[2:4] = 0
    landed, _ = distort(np.array([fold]), np.zeros(1), radial_only)
    return float(landed[0] / corner)


def solve_lens(
    views: Sequence[BoardView], size: tuple[int, int], model: LensModel | None = None, holdout: bool = True
) -> LensSolution:
    """The lens of pictures of `size` (width, height). Raises LensError; never returns what is not finite."""
    model = model or LensModel()
    views = sorted(views, key=lambda view: view.name)
    if len(views) < FEWEST_VIEWS:
        have = "no view" if not views else "one view" if len(views) == 1 else f"{len(views)} views"
        raise LensError(
            f"A lens cannot be told from {have} of the board: "
            f"{FEWEST_VIEWS} are the least, 10 to 20 are good."
        )
    _check_finite(views)
    start, poses = _started(views, size, model)
    refined = refine(views, start, poses, model)
    solved = tuple(_placed(view, refined.lens, pose) for view, pose in zip(views, refined.poses, strict=True))
    rms = _rms([view.residuals for view in solved])
    held = _holdout(views, refined, model) if holdout else None
    return LensSolution(refined.lens, model, refined.sigma, rms, held, solved)


def _check_finite(views: Sequence[BoardView]) -> None:
    for view in views:
        if not (np.isfinite(view.pixels).all() and np.isfinite(view.points).all()):
            raise LensError(f"A point of {view.name} is not a finite number; leave this view out.")


def _started(views: Sequence[BoardView], size: tuple[int, int], model: LensModel) -> tuple[Lens, Floats]:
    """OpenCV's lens and poses, from its own start, and where that leads nowhere from a plain one."""
    best: tuple[float, Lens, Floats] | None = None
    for matrix in (None, _plain(size, 1.0), _plain(size, 2.5)):
        found = _attempt(views, size, model, matrix)
        if found and (best is None or found[0] < best[0]):
            best = found
        if best and best[0] < WORST / 10:
            break
    if best is None or best[0] > WORST:
        raise LensError(
            "No lens explains these views. Check the board's size and kind, and that all pictures come "
            "from one camera with one zoom; views that all look at the board straight on do not tell a lens."
        )
    return best[1:]


def _attempt(
    views: Sequence[BoardView], size: tuple[int, int], model: LensModel, matrix: Floats | None
) -> tuple[float, Lens, Floats] | None:
    """RMS, lens and poses by OpenCV; None where what it calls a success is none."""
    guess = cv2.CALIB_USE_INTRINSIC_GUESS if matrix is not None else 0
    # With a fixed aspect OpenCV reads the ratio from the matrix.
    matrix = np.eye(3) if matrix is None else matrix
    points = [view.points.astype(np.float32) for view in views]
    pixels = [view.pixels.astype(np.float32).reshape(-1, 1, 2) for view in views]
    try:
        with _one_thread():
            rms, found, bent, rvecs, tvecs = cv2.calibrateCamera(
                points, pixels, size, matrix, np.zeros(model.length), flags=model.flags | guess, criteria=STOP
            )
    except cv2.error:
        return None
    numbers = np.asarray(bent, dtype=np.float64).ravel()[: model.length]
    lens = Lens(*size, np.asarray(found, dtype=np.float64), numbers)
    poses = np.column_stack((np.reshape(rvecs, (-1, 3)), np.reshape(tvecs, (-1, 3)))).astype(np.float64)
    return (float(rms), lens, poses) if _is_sane(lens, poses, rms) else None


@contextmanager
def _one_thread() -> Iterator[None]:
    """Several threads add up in another order each time, and the same views would give other digits."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield
    finally:
        cv2.setNumThreads(threads)


def _is_sane(lens: Lens, poses: Floats, rms: float) -> bool:
    numbers = (lens.matrix.ravel(), lens.distortion, poses.ravel(), [rms])
    finite = all(np.isfinite(values).all() for values in numbers)
    return bool(finite and lens.matrix[0, 0] > 0 and lens.matrix[1, 1] > 0 and (poses[:, 5] > 0).all())


def _plain(size: tuple[int, int], factor: float) -> Floats:
    width, height = size
    focal = factor * max(size)
    return np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1.0]])


def _placed(view: BoardView, lens: Lens, pose: Floats) -> SolvedView:
    return SolvedView(view, pose[:3], pose[3:], _residuals(view, lens, pose[:3], pose[3:]))


def _residuals(view: BoardView, lens: Lens, rvec: Floats, tvec: Floats) -> Floats:
    computed, _ = cv2.projectPoints(view.points, rvec, tvec, lens.matrix, lens.distortion)
    return view.pixels - computed.reshape(-1, 2).astype(np.float64)


def _rms(residuals: Sequence[Floats]) -> float:
    every = np.concatenate(residuals)
    return float(np.sqrt((every**2).sum() / len(every)))


def _holdout(views: Sequence[BoardView], refined: Refined, model: LensModel) -> float | None:
    """RMS of views by lenses that were solved without them; only their poses are theirs."""
    folds = min(FOLDS, len(views))
    if len(views) - -(-len(views) // folds) < FEWEST_VIEWS:
        return None
    residuals: list[Floats] = []
    for fold in range(folds):
        rest = [index for index in range(len(views)) if index % folds != fold]
        other = refine([views[index] for index in rest], refined.lens, refined.poses[rest], model).lens
        for view in views[fold::folds]:
            posed = _posed(view, other)
            if posed is None:
                return None
            residuals.append(posed)
    return _rms(residuals)


def _posed(view: BoardView, lens: Lens) -> Floats | None:
    found, rvec, tvec = cv2.solvePnP(view.points, view.pixels, lens.matrix, lens.distortion)
    if not found:
        return None
    residuals = _residuals(view, lens, rvec.ravel().astype(np.float64), tvec.ravel().astype(np.float64))
    return residuals if np.isfinite(residuals).all() else None
