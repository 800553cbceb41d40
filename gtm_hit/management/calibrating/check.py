"""`manage.py calibrate check`: where things are that were clicked in several views."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from django.core.management.base import CommandError

from gtm_hit.calibration.checking import CLICK_SIGMA, Click, Spot, shown, spot
from gtm_hit.formats.calibration.clicks import ThingClick, read_clicks
from gtm_hit.formats.problems import FormatError
from gtm_hit.geometry.camera import CalibrationError, Camera
from gtm_hit.management.calibrating.reading import add_calibration, read_cameras

HELP = "Tell where things clicked in two or more views are, how sure that is, and which click is off."


def add_arguments(parser: ArgumentParser) -> None:
    add_calibration(parser)
    parser.add_argument("clicks", type=Path, help="CSV of thing,camera,x,y or a JSON list of such objects")
    parser.add_argument(
        "--sigma", type=float, default=CLICK_SIGMA, metavar="PIXELS", help=f"of a click ({CLICK_SIGMA:g})"
    )


def run(options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
    if not 0 < options["sigma"] < float("inf"):
        raise CommandError("--sigma must be above 0.")
    try:
        cameras = read_cameras(options)
        clicks = read_clicks(options["clicks"])
    except (FormatError, CalibrationError) as error:
        raise CommandError(str(error)) from error
    by_name = {camera.name: camera for camera in cameras}
    for click in clicks:
        if click.camera not in by_name:
            raise CommandError(f"{click.thing}: no camera {click.camera}; there are {', '.join(by_name)}")
    things = list(dict.fromkeys(click.thing for click in clicks))
    told = [
        _thing(thing, [click for click in clicks if click.thing == thing], by_name, options["sigma"])
        for thing in things
    ]
    for each in told:
        say(_line(each))
    residuals = [view["residual_px"] for each in told for view in each["clicks"] if "residual_px" in view]
    return {
        "things": told,
        "median_px": float(np.median(residuals)) if residuals else None,
        "doubtful": sum(view.get("doubtful", False) for each in told for view in each["clicks"]),
    }


def _thing(
    thing: str, clicks: Sequence[ThingClick], cameras: dict[str, Camera], sigma: float
) -> dict[str, Any]:
    found = spot([Click(cameras[click.camera], click.x, click.y) for click in clicks], sigma)
    told: dict[str, Any] = {
        "thing": thing,
        "clicks": [{"camera": click.camera, "x": click.x, "y": click.y} for click in clicks],
    }
    if found is None:
        few = "in one view only" if len(clicks) < 2 else "along rays that meet nowhere the views show"
        return {**told, "point": None, "reason": f"clicked {few}"}
    for view, residual, doubtful in zip(
        told["clicks"], found.residuals.tolist(), found.doubtful.tolist(), strict=True
    ):
        view |= {"residual_px": residual, "doubtful": doubtful}
    return {**told, **_place(found), "shown": _shown(found, cameras, {click.camera for click in clicks})}


def _place(found: Spot) -> dict[str, Any]:
    return {
        "point": found.point.tolist(),
        "sigmas_cm": (100 * found.sigmas).tolist(),
        "ground": found.point[:2].tolist(),
        "ground_sigma_cm": 100 * found.ground_sigma,
        "height": float(found.point[2]),
        "angle_degrees": found.angle,
    }


def _shown(found: Spot, cameras: dict[str, Camera], clicked: set[str]) -> dict[str, list[float]]:
    """Pixels in the other views, those whose pictures show them."""
    pixels = {name: shown(camera, found.point) for name, camera in cameras.items() if name not in clicked}
    return {
        name: pixel.tolist()
        for name, pixel in pixels.items()
        if (pixel >= 0).all() and pixel[0] < cameras[name].width and pixel[1] < cameras[name].height
    }


def _line(told: dict[str, Any]) -> str:
    if told["point"] is None:
        return f"{told['thing']}: {told['reason']}"
    x, y, z = told["point"]
    views = ", ".join(
        f"{view['camera']} {view['residual_px']:.1f} px{' (off)' if view['doubtful'] else ''}"
        for view in told["clicks"]
    )
    return f"{told['thing']}: {x:.3f}, {y:.3f}, {z:.3f} m ± {told['ground_sigma_cm']:.1f} cm; {views}"
