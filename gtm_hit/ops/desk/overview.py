"""How far a desk is: each camera's steps with a verdict in words, and the one next step."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from gtm_hit.models import Desk, DeskCamera
from gtm_hit.ops.desk import adjust_inputs, adjust_results, poses


class Verdict(StrEnum):
    GOOD = "good"
    USABLE = "usable"
    DO_NOT_USE = "do not use"
    MISSING = "missing"


class Page(StrEnum):
    """Where a step is done."""

    DESK = "desk"
    LENS = "lens"
    GROUND = "ground"
    ADJUST = "adjust"
    PLACE = "place"


@dataclass(frozen=True)
class Step:
    verdict: Verdict
    words: str

    @property
    def usable(self) -> bool:
        """Whether one can go on from here."""
        return self.verdict in {Verdict.GOOD, Verdict.USABLE}


@dataclass(frozen=True)
class CameraSteps:
    name: str
    lens: Step
    ground: Step
    row: DeskCamera

    @property
    def ready(self) -> bool:
        return Verdict.MISSING not in {self.lens.verdict, self.ground.verdict}


@dataclass(frozen=True)
class NextStep:
    words: str
    page: Page
    camera: str = ""


@dataclass(frozen=True)
class Overview:
    cameras: list[CameraSteps]
    points: int
    next_step: NextStep
    adjust: Step  # of all cameras together

    @property
    def ready(self) -> bool:
        """Whether there is a calibration of every camera, be it a good one or not."""
        return bool(self.cameras) and all(each.ready for each in self.cameras)


SHARP_WIDTH = 640  # a good pose is off by this part of the picture's width at most: 3 px of 1920


def overview(desk: Desk) -> Overview:
    cameras = [CameraSteps(row.name, lens_step(row), ground_step(row), row) for row in desk.cameras.all()]
    points = desk.points.count()
    adjust = adjust_step(desk)
    return Overview(cameras, points, _next(cameras, points, adjust), adjust)


def lens_step(camera: DeskCamera) -> Step:
    if camera.lens is None:
        return Step(Verdict.MISSING, "No lens yet.")
    report = camera.lens_report
    if "verdict" in report:
        return Step(Verdict(report["verdict"]), report["words"])
    return Step(Verdict.USABLE, f"From {camera.lens['source']}; nothing here says how good it is.")


def adjust_step(desk: Desk) -> Step:
    """Good where a result is used, missing where there are clicks to adjust with."""
    used, shared = adjust_results.in_use(desk), adjust_inputs.shared(desk)
    if used.ended:
        changed = ", ".join(used.ended)
        return Step(Verdict.MISSING, f"Lens or clicks of {changed} changed after adjusting: adjust again.")
    if used.number is not None:
        since = adjust_results.changes(desk, adjust_results.result_of(desk, used.number))
        told = f"By result {used.number}."
        return Step(Verdict.USABLE if since else Verdict.GOOD, " ".join([told, *since]))
    if shared.enough:
        return Step(
            Verdict.MISSING, f"Not adjusted yet; {shared.free} points are seen by two cameras or more."
        )
    least = adjust_inputs.FEWEST
    return Step(Verdict.USABLE, f"Nothing to adjust: fewer than {least} shared points. It can go without.")


def ground_step(camera: DeskCamera) -> Step:
    report = camera.pose_report
    if camera.pose is None:
        clicked = camera.clicks.count()
        if clicked == 0:
            return Step(Verdict.MISSING, "No point clicked yet.")
        return Step(Verdict.MISSING, report.get("problem") or poses.NO_LENS)
    return _posed(camera, report)


def _posed(camera: DeskCamera, report: dict[str, Any]) -> Step:
    used = sum(each["used"] for each in report["residuals"])
    spread = sum((each or 0.0) ** 2 for each in report["centre_sigma"]) ** 0.5
    told = f"{used} points, {report['rms']:.2f} px, centre ± {100 * spread:.1f} cm."
    first = next((each["text"] for each in report["findings"]), "")
    if report["rms"] > 3 * camera.width / SHARP_WIDTH:
        return Step(Verdict.DO_NOT_USE, f"{told} {first}".strip())
    if first or report["rms"] > camera.width / SHARP_WIDTH:
        return Step(Verdict.USABLE, f"{told} {first}".strip())
    return Step(Verdict.GOOD, told)


def _next(cameras: list[CameraSteps], points: int, adjust: Step) -> NextStep:
    if not cameras:
        return NextStep("Add the cameras.", Page.DESK)
    for each in cameras:
        if each.lens.verdict in {Verdict.MISSING, Verdict.DO_NOT_USE}:
            return NextStep(f"Find the lens of {each.name}.", Page.LENS, each.name)
    if not points:
        return NextStep("Say which points were measured.", Page.GROUND)
    for each in cameras:
        if not each.row.full_digest:
            return NextStep(f"Send a picture of the ground for {each.name}.", Page.GROUND, each.name)
        if each.ground.verdict is Verdict.MISSING:
            return NextStep(f"Click points in {each.name}.", Page.GROUND, each.name)
        if each.ground.verdict is Verdict.DO_NOT_USE:
            return NextStep(f"Look at what is wrong in {each.name}.", Page.GROUND, each.name)
    if adjust.verdict is Verdict.MISSING:
        return NextStep("Adjust all cameras together.", Page.ADJUST)
    return NextStep("Put the calibration in place.", Page.PLACE)
