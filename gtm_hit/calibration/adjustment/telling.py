"""A result in words and as JSON."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from gtm_hit.calibration.adjustment.adjusting import Adjustment
from gtm_hit.calibration.adjustment.report import CameraReport, Misses, Report


def content(result: Adjustment, report: Report) -> dict[str, Any]:
    """All of it as JSON has it: metres, pixels, None for what is infinite or unknown."""
    hold_out = report.hold_out
    told = {
        "variant": result.variant.value,
        "finished": result.finished,
        "cost": result.cost.total,
        "cost_of_clicks": result.cost.clicks,
        "cost_of_priors": result.cost.known,
        "steps": result.steps,
        "median_px": report.after.median,
        "centres": {camera.name: list(camera.centre) for camera in report.cameras},
        "monotone": report.monotone,
        "before": asdict(report.before),
        "after": asdict(report.after),
        "measured_before": asdict(report.measured_before),
        "measured_after": asdict(report.measured_after),
        "hold_out": {
            "points": hold_out.points,
            "clicks": int(hold_out.misses.size),
            "median_px": hold_out.share(50),
            "p75_px": hold_out.share(75),
            "p90_px": hold_out.share(90),
            "undetermined": hold_out.undetermined,
        },
        "feet": report.feet and asdict(report.feet),
        "cameras": [_camera(camera) for camera in report.cameras],
        "worst": [asdict(observation) for observation in report.worst],
        "notices": list(result.notices),
    }
    return _finite(told)


def lines(result: Adjustment, report: Report) -> Iterator[str]:
    """For people, camera by camera."""
    yield (
        f"cost {result.cost.total:,.1f} after {result.steps} steps "
        f"(clicks {result.cost.clicks:,.1f}, priors {result.cost.known:,.1f})"
    )
    yield f"clicks    {_misses(report.before)}  →  {_misses(report.after)}"
    yield f"measured  {_misses(report.measured_before)}  →  {_misses(report.measured_after)}"
    for camera in report.cameras:
        yield from _camera_lines(camera)
    hold_out = report.hold_out
    if hold_out.points:
        yield (
            f"left out of one view: {hold_out.share(50):.2f} px median, {hold_out.share(90):.1f} px for 90 % "
            f"({hold_out.misses.size} clicks of {hold_out.points} points)"
        )
    if report.feet:
        feet = report.feet
        yield (
            f"feet: {100 * feet.median:.1f} cm off the ground (median of {feet.count}), "
            f"spread ± {100 * feet.spread:.1f} cm"
        )
    yield "worst clicks:"
    for one in report.worst:
        noun, (x, y) = "measured point" if one.measured else "point", one.clicked
        yield f"  {one.miss:7.1f} px  {one.camera} {noun} {one.point} at {x:g}, {y:g}"
    yield from result.notices


def _camera_lines(camera: CameraReport) -> Iterator[str]:
    sigma = "" if camera.centre_sigma is None else f" ± {100 * camera.centre_sigma:.1f} cm"
    x, y, z = camera.centre
    yield (
        f"{camera.name}: {_misses(camera.before)}  →  {_misses(camera.after)}; at {x:.3f}, {y:.3f}, {z:.3f} m"
        f"{sigma}, moved {100 * camera.moved:.1f} cm"
    )
    far = [f"{name} by {shift.shift:+.1f} σ" for name, shift in camera.lens.items() if abs(shift.shift) > 3]
    if far:
        yield f"  far from what the lens step found: {', '.join(far)}"
    if not camera.folding.monotone:
        yield (
            f"  the lens folds at {camera.folding.reach:.3f} focal lengths, the corner is at "
            f"{camera.folding.corner:.3f}: nothing can be seen beyond"
        )


def _camera(camera: CameraReport) -> dict[str, Any]:
    told = asdict(camera)
    told["folding"]["monotone"] = camera.folding.monotone
    return told


def _misses(misses: Misses) -> str:
    if misses.median is None:
        return "none"
    return f"{misses.median:.2f} / {misses.p95:.1f} / {misses.rms:.1f} px"


def _finite(value: Any) -> Any:
    """The same without numbers that JSON does not have."""
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
