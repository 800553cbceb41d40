"""A solved lens as plain numbers, for files, REST and the command alike."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from gtm_hit.calibration.choosing import coverage
from gtm_hit.calibration.intrinsics import LensSolution, SolvedView
from gtm_hit.calibration.verdict import Verdict, outlier, tilts, worst_view
from gtm_hit.calibration.views import NotFound


def lens_report(solution: LensSolution, verdict: Verdict) -> dict[str, Any]:
    """Pixels, except where said; no number that JSON does not know."""
    lens = solution.lens
    bad = outlier(solution)
    seen = coverage([view.view for view in solution.views], (lens.width, lens.height))
    return {
        "image_size": [lens.width, lens.height],
        "camera_matrix": lens.matrix.tolist(),
        "distortion": lens.distortion.tolist(),
        "model": solution.model.as_json(),
        "rms": solution.rms,
        "holdout_rms": solution.holdout_rms,
        "sigma": solution.sigma,
        "fold_radius": _finite(solution.fold_radius),
        "reach": _finite(solution.reach),
        "coverage": seen.tolist(),
        **verdict.as_json(),
        "worst_view": worst_view(solution).name,
        "bad_view": bad.name if bad else None,
        "views": _views(solution),
    }


def missing_report(missing: Sequence[NotFound]) -> list[dict[str, Any]]:
    return [{"name": each.name, "reason": each.reason} for each in missing]


def _views(solution: LensSolution) -> list[dict[str, Any]]:
    return [
        _view(view) | {"tilt_degrees": tilt.angle}
        for view, tilt in zip(solution.views, tilts(solution), strict=True)
    ]


def _view(view: SolvedView) -> dict[str, Any]:
    return {
        "name": view.name,
        "rms": view.rms,
        "points": len(view.residuals),
        "rvec": view.rvec.tolist(),
        "tvec": view.tvec.tolist(),
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
