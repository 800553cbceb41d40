"""What a result is worth: misses before and after, what moved and by how much, and what was not asked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment.adjusting import Adjustment
from gtm_hit.calibration.adjustment.checks import shared_points
from gtm_hit.calibration.adjustment.holdout import HoldOut, leave_one_view_out
from gtm_hit.calibration.adjustment.parameters import packed
from gtm_hit.calibration.adjustment.problem import PARAMETERS, feet_of_pairs
from gtm_hit.calibration.adjustment.residuals import projections
from gtm_hit.calibration.adjustment.settling import settled
from gtm_hit.calibration.adjustment.system import all_points, lens_information
from gtm_hit.calibration.folding import Folding, folding

Floats = NDArray[np.float64]

WORST = 20


@dataclass(frozen=True)
class Misses:
    """Pixels; None where nothing was clicked."""

    count: int
    median: float | None
    p95: float | None
    rms: float | None


@dataclass(frozen=True)
class Shift:
    """A number of a lens: was, is, how far that may be off, and its shift in σ of the lens step."""

    before: float
    after: float
    sigma: float | None  # None where it was stopped before that was known
    shift: float


@dataclass(frozen=True)
class CameraReport:
    name: str
    before: Misses  # of free points, where the problem had them
    after: Misses
    measured_before: Misses
    measured_after: Misses
    centre: tuple[float, float, float]  # metres
    centre_sigma: float | None  # metres, of all three together
    moved: float  # metres the camera went
    lens: Mapping[str, Shift]
    folding: Folding
    shared: Mapping[str, int]  # free points that each other camera saw too


@dataclass(frozen=True)
class Observation:
    """One click and where the result has its point."""

    camera: str
    point: int  # among the free or the measured points
    measured: bool
    clicked: tuple[float, float]
    projected: tuple[float, float]
    miss: float  # pixels


@dataclass(frozen=True)
class Feet:
    """How high feet came to stand that nobody told to be on the ground, metres."""

    count: int
    median: float  # of the heights without their signs
    mean: float
    spread: float  # 1.48 × median distance from the median: a σ that bad clicks do not move
    guessed: bool  # nobody said which points are feet: those that have a head above them


@dataclass(frozen=True)
class Report:
    cameras: tuple[CameraReport, ...]
    before: Misses
    after: Misses
    measured_before: Misses
    measured_after: Misses
    worst: tuple[Observation, ...]
    hold_out: HoldOut
    feet: Feet | None

    @property
    def monotone(self) -> bool:
        return all(camera.folding.monotone for camera in self.cameras)


def report_of(result: Adjustment) -> Report:
    problem, seen = result.problem, result.seen
    free = len(problem.points)
    is_measured = seen.points >= free
    rows_before, rows = packed(problem.views), packed(result.views)
    start = _placed(result, rows_before)
    here = np.concatenate((np.nan_to_num(result.points), result.measured))
    before = _lengths(projections(rows_before, start, seen) - seen.pixels)
    projected = projections(rows, here, seen)
    after = _lengths(projected - seen.pixels)
    cameras = tuple(
        _camera(result, number, before, after, is_measured) for number in range(len(problem.views))
    )
    return Report(
        cameras,
        _misses(before[~is_measured]),
        _misses(after[~is_measured]),
        _misses(before[is_measured]),
        _misses(after[is_measured]),
        _worst(result, projected, after),
        leave_one_view_out(result.views, seen, free, result.settings.turn),
        _feet(result),
    )


def _placed(result: Adjustment, rows: Floats) -> Floats:
    """Where the points were, those that had no place being where the first cameras see them."""
    points = all_points(result.problem)
    unknown = np.zeros(len(points), dtype=bool)
    unknown[np.isnan(points[:, 0])] = True
    if not unknown.any():
        return points
    found = settled(rows, points, result.seen, unknown, result.settings.turn)
    return np.where(unknown[:, None], found, points)


def _camera(
    result: Adjustment, number: int, before: Floats, after: Floats, is_measured: NDArray[np.bool_]
) -> CameraReport:
    problem, view, was = result.problem, result.views[number], result.problem.views[number]
    of_camera = result.seen.cameras == number
    free, measured = of_camera & ~is_measured, of_camera & is_measured
    centre, known = view.camera().centre, result.uncertainty
    shared = shared_points(result.seen, len(problem.views), len(problem.points))[number]
    return CameraReport(
        name=view.name,
        before=_misses(before[free]),
        after=_misses(after[free]),
        measured_before=_misses(before[measured]),
        measured_after=_misses(after[measured]),
        centre=(float(centre[0]), float(centre[1]), float(centre[2])),
        centre_sigma=None if known is None else float(np.linalg.norm(known.centres[number])),
        moved=float(np.linalg.norm(centre - was.camera().centre)),
        lens=_shifts(result, number),
        folding=folding(view.lens),
        shared={
            other: int(count)
            for place, (other, count) in enumerate(zip(problem.names, shared, strict=True))
            if place != number
        },
    )


def _shifts(result: Adjustment, number: int) -> dict[str, Shift]:
    before, after = packed(result.problem.views)[number], packed(result.views)[number]
    information = lens_information(result.problem, result.settings, before.size)[number]
    known = result.uncertainty
    places = range(6, 10 + result.views[number].lens.distortion.size)
    return {
        PARAMETERS[place]: Shift(
            before=float(before[place]),
            after=float(after[place]),
            sigma=None if known is None else float(known.numbers[number, place]),
            shift=float((after[place] - before[place]) * np.sqrt(information[place])),
        )
        for place in places
    }


def _worst(result: Adjustment, projected: Floats, after: Floats) -> tuple[Observation, ...]:
    seen, free = result.seen, len(result.problem.points)
    chosen = np.argsort(-after, kind="stable")[:WORST]
    found = []
    for row in chosen.tolist():
        point = int(seen.points[row])
        (x, y), (u, v) = seen.pixels[row].tolist(), projected[row].tolist()
        name = result.problem.names[seen.cameras[row]]
        number = point - free if point >= free else point
        found.append(Observation(name, number, point >= free, (x, y), (u, v), float(after[row])))
    return tuple(found)


def _feet(result: Adjustment) -> Feet | None:
    told = result.problem.feet
    heights = result.points[feet_of_pairs(result.points) if told is None else told, 2]
    heights = heights[np.isfinite(heights)]
    if not heights.size:
        return None
    spread = 1.4826 * float(np.median(np.abs(heights - np.median(heights))))
    return Feet(heights.size, float(np.median(np.abs(heights))), float(heights.mean()), spread, told is None)


def _lengths(missed: Floats) -> Floats:
    return np.hypot(missed[:, 0], missed[:, 1])


def _misses(lengths: Floats) -> Misses:
    if not lengths.size:
        return Misses(0, None, None, None)
    rms = float(np.sqrt((lengths**2).mean()))
    return Misses(lengths.size, float(np.median(lengths)), float(np.percentile(lengths, 95)), rms)
