"""A desk as the problem of a bundle adjustment."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np

from gtm_hit.calibration.adjustment import checks
from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.problem import LENS, Problem, Sightings, View
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.calibration.adjustment.state import digest_of
from gtm_hit.calibration.adjustment.system import observations
from gtm_hit.calibration.lens_numbers import Lens
from gtm_hit.models import Desk, DeskCamera
from gtm_hit.ops.desk import adjust_clicks, poses
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.adjust_clicks import FEET, GROUND, Clicked
from gtm_hit.ops.desk.errors import DeskError

FEWEST = 6  # points that two cameras see: below, there is nothing to adjust with

Point = tuple[str, str]  # source and name


@dataclass(frozen=True, eq=False)
class Inputs:
    problem: Problem
    free: tuple[Point, ...]  # the problem's points
    measured: tuple[Point, ...]
    notices: tuple[str, ...]  # what was left out
    snapshot: dict[str, Any]  # as JSON: to say later what has changed since
    digest: str  # of all that a result depends on


@dataclass(frozen=True)
class Shared:
    """How the cameras hang together."""

    names: tuple[str, ...]
    points: tuple[tuple[int, ...], ...]  # that each two cameras see; on the diagonal, how many each one sees
    measured: tuple[int, ...]  # that each camera sees
    free: int  # points that two cameras or more see

    @property
    def enough(self) -> bool:
        return self.free >= FEWEST


def shared(desk: Desk) -> Shared:
    """By the clicks alone: also before all cameras have a lens and a place."""
    names = tuple(desk.cameras.order_by("index").values_list("name", flat=True))
    clicks = _used(desk)[0]
    saw: dict[Point, set[str]] = {}
    for click in clicks:
        if click.source != GROUND:
            saw.setdefault((click.source, click.point), set()).add(click.camera)
    together = [views for views in saw.values() if len(views) > 1]
    measured = Counter(click.camera for click in clicks if click.source == GROUND)
    matrix = tuple(
        tuple(sum(one in views and other in views for views in together) for other in names) for one in names
    )
    return Shared(names, matrix, tuple(measured[name] for name in names), len(together))


def gather(desk: Desk, choices: Choices) -> Inputs:
    """Raises DeskError that names the cameras which cannot take part, and why."""
    rows = list(desk.cameras.order_by("index"))
    _refuse_missing(rows)
    stays = choices.stays(desk)
    views = tuple(_view(row, stays.get(row.name, frozenset())) for row in rows)
    clicks, single = _used(desk)
    problem, free, measured = _problem(desk, views, clicks, choices.ground_sigma)
    variant = Variant(choices.variant)
    try:
        checks.check(problem)
        checks.usable(problem, observations(problem, choices.settings))
    except AdjustmentError as error:
        raise DeskError(str(error)) from error
    named = json.dumps([free, measured]).encode()
    told = digest_of(problem, variant, choices.settings).encode()
    digest = hashlib.sha256(told + named).hexdigest()
    return Inputs(problem, free, measured, single, _snapshot(desk, rows, clicks), digest)


def snapshot(desk: Desk) -> dict[str, Any]:
    """What a result would begin with now."""
    return _snapshot(desk, list(desk.cameras.order_by("index")), _used(desk)[0])


def _snapshot(desk: Desk, rows: list[DeskCamera], clicks: list[Clicked]) -> dict[str, Any]:
    return {
        "clicks": [[*each.key, each.x, each.y] for each in clicks],
        "measured": {each.name: [each.x, each.y, each.z] for each in desk.points.order_by("number")},
        "cameras": {row.name: poses.beginning(row) for row in rows},
    }


def _used(desk: Desk) -> tuple[list[Clicked], tuple[str, ...]]:
    """Clicks that count, and a sentence on points that are left with one view only."""
    left = adjust_clicks.used(desk)
    views = Counter((each.source, each.point) for each in left)
    used = [each for each in left if each.source == GROUND or views[each.source, each.point] > 1]
    single = [each.point for each in left if each.source != GROUND and views[each.source, each.point] == 1]
    if not single:
        return used, ()
    noun = "1 point is" if len(single) == 1 else f"{len(single)} points are"
    names = ", ".join(single[: checks.NAMED]) + (" …" if len(single) > checks.NAMED else "")
    return used, (f"{noun} seen in one view only and left out: {names}.",)


def _refuse_missing(rows: list[DeskCamera]) -> None:
    if not rows:
        raise DeskError("The desk has no cameras yet.")
    unseen = [row.name for row in rows if row.lens is None]
    unplaced = [row.name for row in rows if row.lens and row.pose is None]
    parts = (
        (unseen, "No lens yet"),
        (unplaced, "No place on the ground to begin from; click 4 measured points or more in"),
    )
    if unseen or unplaced:
        raise DeskError(" ".join(f"{what}: {', '.join(names)}." for names, what in parts if names))


def _view(row: DeskCamera, stays: frozenset[str]) -> View:
    lens = poses.lens_of(row)
    assert lens is not None and row.pose is not None
    if lens.distortion.size == 4:
        lens = Lens(lens.width, lens.height, lens.matrix, np.append(lens.distortion, 0.0))
    rvec, tvec = (np.array(row.pose[name], dtype=np.float64) for name in ("rvec", "tvec"))
    known: dict[str, float] = row.lens_report.get("sigma") or {}
    sigmas = {name: value for name, value in known.items() if name in LENS and value > 0}
    if sigmas and "fy" not in sigmas and "fx" in sigmas:
        sigmas["fy"] = sigmas["fx"]  # solved with square pixels
    # What the lens step did not solve, a simpler model leaves at 0, is not solved here either.
    unsolved = frozenset(LENS) - frozenset(sigmas) if sigmas else frozenset()
    return View(row.name, lens, rvec, tvec, stays | unsolved, sigmas)


def _problem(
    desk: Desk, views: tuple[View, ...], clicks: list[Clicked], sigma: float
) -> tuple[Problem, tuple[Point, ...], tuple[Point, ...]]:
    places = {view.name: place for place, view in enumerate(views)}
    free = [each for each in clicks if each.source != GROUND]
    ground = [each for each in clicks if each.source == GROUND]
    parts = {(each.source, each.point): each.part for each in free}
    clicked = {each.point for each in ground}
    rows = [row for row in desk.points.order_by("number") if row.name in clicked]
    measured = {(GROUND, row.name): [row.x, row.y, row.z] for row in rows}
    known_feet = any(parts.values())
    return (
        Problem(
            views,
            np.full((len(parts), 3), np.nan),
            _sightings(free, list(parts), places),
            np.array(list(measured.values()), dtype=np.float64).reshape(-1, 3),
            _sightings(ground, list(measured), places),
            measured_sigma=sigma,
            feet=np.array([part == FEET for part in parts.values()], dtype=bool) if known_feet else None,
            labels=(*(name for _, name in parts), *(name for _, name in measured)),
        ),
        tuple(parts),
        tuple(measured),
    )


def _sightings(clicks: list[Clicked], points: list[Point], cameras: dict[str, int]) -> Sightings:
    numbers = {point: number for number, point in enumerate(points)}
    return Sightings(
        np.array([cameras[each.camera] for each in clicks], dtype=np.int64),
        np.array([numbers[each.source, each.point] for each in clicks], dtype=np.int64),
        np.array([[each.x, each.y] for each in clicks], dtype=np.float64).reshape(-1, 2),
    )
