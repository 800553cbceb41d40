"""Whether a solved lens can be trusted, in words, why, and the one thing to do next.

A small RMS proves nothing: a lens with the principal point outside the picture can have half a pixel.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from gtm_hit.calibration.choosing import Tilt, coverage, tilt_at
from gtm_hit.calibration.intrinsics import LensSolution, SolvedView
from gtm_hit.calibration.lens_models import Coefficients

FEW_VIEWS, GOOD_VIEWS = 5, 8
LOOSE_FOCAL, WIDE_FOCAL = 0.004, 0.02  # sigma, share of the focal length
LOOSE_CENTRE, WIDE_CENTRE = 0.0075, 0.03  # sigma, share of the picture's width
ODD_ASPECT, WRONG_ASPECT = 0.02, 0.06  # fx / fy - 1
OFF_CENTRE = 0.15  # of the picture's side, from its middle
HIGH_RMS, TOO_HIGH_RMS = 0.5, 1.5  # pixels
HOLDOUT = 3.0  # times the RMS
SPARSE, BARE = 0.55, 0.25  # share of cells with points
FOLD_NEAR = 0.85  # of the farthest corner's distance
ONE_WAY = 160.0  # degrees: views that lean into less of the circle lean one way
NARROW = 12.0  # degrees between the two views that differ most
OUTLIER = 2.5  # times the others' median RMS
OUTLIER_PIXELS = 0.3


class Word(StrEnum):
    GOOD = "good"
    USABLE = "usable"
    DO_NOT_USE = "do not use"


@dataclass(frozen=True)
class Reason:
    code: str
    text: str
    step: str  # what to do about it
    severe: bool  # such a lens must not be used


@dataclass(frozen=True)
class Verdict:
    word: Word
    reasons: tuple[Reason, ...]  # the gravest first
    next_step: str

    def as_json(self) -> dict[str, Any]:
        reasons = [{"code": each.code, "text": each.text, "severe": each.severe} for each in self.reasons]
        return {"verdict": self.word.value, "reasons": reasons, "next_step": self.next_step}


def judge(solution: LensSolution) -> Verdict:
    """The verdict on a lens."""
    found = [reason for check in CHECKS if (reason := check(solution))]
    found.sort(key=lambda reason: not reason.severe)
    if not found:
        return Verdict(Word.GOOD, (), "Nothing more is needed: go on with the ground.")
    word = Word.DO_NOT_USE if found[0].severe else Word.USABLE
    return Verdict(word, tuple(found), found[0].step)


def worst_view(solution: LensSolution) -> SolvedView:
    return max(solution.views, key=lambda view: (view.rms, view.name))


def outlier(solution: LensSolution) -> SolvedView | None:
    """The one view that fits much worse than the others, if there is one."""
    worst = worst_view(solution)
    others = [view.rms for view in solution.views if view is not worst]
    bad = worst.rms > max(OUTLIER * float(np.median(others)), OUTLIER_PIXELS)
    return worst if bad else None


def tilts(solution: LensSolution) -> list[Tilt]:
    return [tilt_at(view.rvec, view.tvec) for view in solution.views]


def covered(solution: LensSolution) -> float:
    """Share of the picture's cells in which points were seen."""
    size = (solution.lens.width, solution.lens.height)
    return float((coverage([view.view for view in solution.views], size) > 0).mean())


def _centre(solution: LensSolution) -> Reason | None:
    lens = solution.lens
    cx, cy = lens.matrix[0, 2], lens.matrix[1, 2]
    text = f"The principal point ({cx:.0f}, {cy:.0f}) lies"
    if not (0 <= cx <= lens.width - 1 and 0 <= cy <= lens.height - 1):
        return Reason(
            "centre outside",
            f"{text} outside the picture of {lens.width}×{lens.height} px; no ordinary camera has that.",
            _more_tilts(solution),
            True,
        )
    off_x, off_y = abs(cx / (lens.width - 1) - 0.5), abs(cy / (lens.height - 1) - 0.5)
    if max(off_x, off_y) > OFF_CENTRE:
        share = round(100 * max(off_x, off_y))
        return Reason("centre far", f"{text} {share} % off the middle.", _more_tilts(solution), False)
    return None


def _uncertain(solution: LensSolution) -> Reason | None:
    numbers, sigma = solution.parameters, solution.sigma
    focal = max(sigma["fx"] / numbers["fx"], sigma["fy"] / numbers["fy"])
    centre = max(sigma.get("cx", 0.0), sigma.get("cy", 0.0)) / solution.lens.width
    if focal <= LOOSE_FOCAL and centre <= LOOSE_CENTRE:
        return None
    severe = focal > WIDE_FOCAL or centre > WIDE_CENTRE
    names, what = ("cx", "cy"), "The principal point"
    if focal / LOOSE_FOCAL >= centre / LOOSE_CENTRE:
        names, what = ("fx", "fy"), "The focal length"
    which = ", ".join(f"{name} = {numbers[name]:.0f} ± {sigma[name]:.1f}" for name in names)
    text = f"{what} is {'hardly' if severe else 'only roughly'} known: {which} px."
    return Reason("uncertain", text, _more_tilts(solution), severe)


def _one_way(solution: LensSolution) -> Reason | None:
    every = tilts(solution)
    if _widest_angle(solution) < NARROW:
        text = (
            f"All views look at the board from nearly one direction (within {_widest_angle(solution):.0f}°): "
            "focal length and distance cannot be told apart."
        )
        return Reason("parallel", text, _more_tilts(solution), True)
    leaning = sorted(tilt.direction for tilt in every if tilt.angle >= 10)
    gaps = np.diff([*leaning, leaning[0] + 360]) if leaning else np.array([360.0])
    if 360 - gaps.max() < ONE_WAY:
        text = "The board leans one way only in all views."
        return Reason("one way", text, _more_tilts(solution), False)
    return None


def _widest_angle(solution: LensSolution) -> float:
    """Degrees between the two views' boards that differ most."""
    normals = np.array([_normal(view) for view in solution.views])
    return float(np.degrees(np.arccos(np.clip((normals @ normals.T).min(), -1, 1))))


def _normal(view: SolvedView) -> np.ndarray:
    angle = np.linalg.norm(view.rvec)
    axis = view.rvec / angle if angle else view.rvec
    z = np.array([0.0, 0.0, 1.0])
    turned = z * np.cos(angle) + np.cross(axis, z) * np.sin(angle) + axis * axis[2] * (1 - np.cos(angle))
    return turned if turned @ view.tvec > 0 else -turned


def _more_tilts(solution: LensSolution) -> str:
    """Into which directions the board has not been turned yet."""
    faces = [(tilt.direction + 180) % 360 for tilt in tilts(solution) if tilt.angle >= 10]
    names = {0: "right", 90: "down", 180: "left", 270: "up"}
    missing = [
        name
        for angle, name in names.items()
        if not any(abs((face - angle + 180) % 360 - 180) <= 50 for face in faces)
    ]
    if missing:
        listed = " and ".join([", ".join(missing[:-1]), missing[-1]] if len(missing) > 1 else missing)
        return f"Add views in which the board is turned 30 to 45° to face {listed}."
    return "Add views closer to the camera in which the board is turned 30 to 45°, in all directions."


def _views(solution: LensSolution) -> Reason | None:
    count = len(solution.views)
    if count >= GOOD_VIEWS:
        return None
    text = f"{count} views are few; 10 to 20 are good."
    return Reason("few views", text, _more_tilts(solution), count < FEW_VIEWS)


def _outlier(solution: LensSolution) -> Reason | None:
    view = outlier(solution)
    if view is None:
        return None
    others = float(np.median([other.rms for other in solution.views if other is not view]))
    text = f"{view.name} fits much worse than the others: {view.rms:.2f} px, where they have {others:.2f} px."
    return Reason("bad view", text, f"Switch off {view.name} and solve again.", False)


def _rms(solution: LensSolution) -> Reason | None:
    if solution.rms <= HIGH_RMS:
        return None
    text = f"The points miss by {solution.rms:.2f} px (RMS); below {HIGH_RMS:g} is good."
    step = "Check that the board is flat and its size right, and leave out blurred views."
    return Reason("high rms", text, step, solution.rms > TOO_HIGH_RMS)


def _held(solution: LensSolution) -> Reason | None:
    held = solution.holdout_rms
    if held is None:
        if len(solution.views) < FEW_VIEWS:
            return None
        text = "When some of the views are left out, no lens can be solved from the others."
        return Reason("unstable", text, _more_tilts(solution), True)
    if held <= HIGH_RMS or held <= HOLDOUT * solution.rms:
        return None
    text = f"Views it was solved without miss by {held:.2f} px, its own by {solution.rms:.2f} px."
    step = "Take a model with fewer coefficients, or more views."
    return Reason("hold-out", text, step, held > 4 * HIGH_RMS)


def _aspect(solution: LensSolution) -> Reason | None:
    numbers = solution.parameters
    odd = abs(numbers["fx"] / numbers["fy"] - 1)
    if odd <= ODD_ASPECT:
        return None
    text = f"fx and fy differ by {100 * odd:.0f} %; pixels are square, so they should be equal."
    return Reason("aspect", text, _more_tilts(solution), odd > WRONG_ASPECT)


def _fold(solution: LensSolution) -> Reason | None:
    if solution.reach >= 1:
        return None
    text = (
        f"The lens folds inside the picture, at {100 * solution.reach:.0f} % of the way to the farthest "
        "corner: nothing can be said about the pixels beyond."
    )
    return Reason("fold", text, _fold_step(solution), solution.reach < FOLD_NEAR)


def _fold_step(solution: LensSolution) -> str:
    if solution.model.coefficients is Coefficients.ONE:
        return "Take a model with at least two coefficients; add views with the board in the corners."
    return "Add views with the board in the picture's corners, or take fewer coefficients."


def _coverage(solution: LensSolution) -> Reason | None:
    share = covered(solution)
    if share >= SPARSE:
        return None
    text = f"Points were seen in {100 * share:.0f} % of the picture only."
    step = f"Add views with the board {_empty_side(solution)}."
    return Reason("coverage", text, step, share < BARE)


def _empty_side(solution: LensSolution) -> str:
    size = (solution.lens.width, solution.lens.height)
    seen = coverage([view.view for view in solution.views], size) > 0
    shares = {
        "at the left edge": seen[:, :3].mean(),
        "at the right edge": seen[:, -3:].mean(),
        "at the upper edge": seen[:2].mean(),
        "at the lower edge": seen[-2:].mean(),
    }
    return min(shares, key=lambda side: shares[side])


def _loose_model(solution: LensSolution) -> Reason | None:
    if solution.model.coefficients is not Coefficients.RATIONAL or solution.sigma["k1"] < 1:
        return None
    text = f"The rational model's numbers cannot be told apart: k1 = {solution.parameters['k1']:.1f} "
    text += f"± {solution.sigma['k1']:.1f}."
    return Reason("loose model", text, "Take the model with five coefficients.", False)


Check = Callable[[LensSolution], Reason | None]
CHECKS: tuple[Check, ...] = (
    _outlier,
    _centre,
    _one_way,
    _views,
    _uncertain,
    _coverage,
    _fold,
    _loose_model,
    _aspect,
    _held,
    _rms,
)
