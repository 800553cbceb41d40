"""What the page Adjust shows, and REST tells: how the cameras hang together, results, the worst clicks."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from gtm_hit.models import Desk, DeskAdjustment, DeskCamera, Image
from gtm_hit.ops.desk import adjust_clicks, adjust_decisions, adjust_inputs, adjust_results, edits
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.adjust_inputs import FEWEST
from gtm_hit.ops.desk.adjust_solving import refuse_too_few
from gtm_hit.ops.desk.errors import DeskError

HALF = 24  # pixels around a click in its thumbnail, at least
LENS_SHIFT = 3.0  # σ of the lens step, from which a number's shift is worth a word


@dataclass(frozen=True)
class WorstClick:
    """One of those farthest off, with its piece of the picture."""

    source: str
    point: str
    camera: str
    x: float
    y: float
    projected_x: float
    projected_y: float
    miss: float  # pixels
    decision: str  # keep, drop, or none
    moved: bool  # since the result: then it is about another place
    digest: str  # of the picture; empty: there is none of its moment
    of_desk: bool  # whether the picture is the desk's own; otherwise a frame of its dataset
    width: int
    height: int

    @property
    def half(self) -> float:
        """Pixels from the middle to the edge of a piece that shows the click and where it should be."""
        away = max(abs(self.x - self.projected_x), abs(self.y - self.projected_y))
        return max(HALF, 0.75 * away)

    @property
    def mark(self) -> float:
        """By how much marks are scaled to look the same in all pieces."""
        return self.half / HALF / 2

    @property
    def view_box(self) -> str:
        half = self.half
        left = (self.x + self.projected_x) / 2 - 1.5 * half
        top = (self.y + self.projected_y) / 2 - half
        return f"{left:.2f} {top:.2f} {3 * half:.2f} {2 * half:.2f}"


def problem(desk: Desk, choices: Choices) -> str:
    """Why the desk cannot be adjusted; empty: it can."""
    try:
        refuse_too_few(desk)
        adjust_inputs.gather(desk, choices)
    except DeskError as error:
        return str(error)
    return ""


def last_choices(desk: Desk) -> Choices:
    last = desk.adjustments.order_by("-number").first()
    return Choices.of_json(last.choices) if last else Choices()


def whole(desk: Desk) -> dict[str, Any]:
    """As JSON values."""
    shared = adjust_inputs.shared(desk)
    used = adjust_results.in_use(desk)
    return {
        "problem": problem(desk, last_choices(desk)),
        "fewest": FEWEST,
        "shared": {
            "cameras": list(shared.names),
            "points": [list(row) for row in shared.points],
            "measured": list(shared.measured),
            "free": shared.free,
        },
        "files": files(desk),
        "dropped": [asdict(click) for click in adjust_decisions.dropped(desk)],
        "results": [brief(each) for each in desk.adjustments.filter(report__isnull=False)],
        "in_use": used.number,
        "ended": list(used.ended),
        **asdict(edits.steps(desk, adjust_results.PAGE)),
    }


def brief(found: DeskAdjustment) -> dict[str, Any]:
    told = found.report or {}
    return {
        "number": found.number,
        "created_at": found.created_at.isoformat(),
        "choices": found.choices,
        "cost": told.get("cost"),
        "median_px": told.get("median_px"),
        "monotone": told.get("monotone"),
    }


def files(desk: Desk) -> list[dict[str, Any]]:
    rows = desk.click_files.filter(used=True).order_by("pk")
    return [{"digest": row.digest, "name": row.name, "points": len(row.points)} for row in rows]


def result(desk: Desk, found: DeskAdjustment) -> dict[str, Any]:
    """All of a result as JSON values."""
    return {
        **brief(found),
        "report": {name: value for name, value in (found.report or {}).items() if name != "worst"},
        "cameras": found.cameras,
        "worst": [asdict(each) for each in worst(desk, found)],
        "since": adjust_results.changes(desk, found),
    }


def worst(desk: Desk, found: DeskAdjustment) -> list[WorstClick]:
    clicks = {click.key: click for click in adjust_clicks.all_clicks(desk)}
    said = adjust_clicks.decided(desk, list(clicks.values()))
    cameras = {row.name: row for row in desk.cameras.all()}
    made = []
    for each in (found.report or {}).get("worst", []):
        key = (each["source"], each["point"], each["camera"])
        click, camera = clicks.get(key), cameras.get(each["camera"])
        if camera is None:
            continue
        (x, y), (u, v) = each["clicked"], each["projected"]
        digest, of_desk = _picture(desk, camera, click)
        made.append(
            WorstClick(
                *key,
                *(x, y, u, v),
                miss=each["miss"],
                decision="keep" if key in said.kept else "drop" if key in said.dropped else "",
                moved=click is None or (click.x, click.y) != (x, y),
                digest=digest,
                of_desk=of_desk,
                width=camera.width,
                height=camera.height,
            )
        )
    return made


def far_shifts(camera: dict[str, Any]) -> list[str]:
    """Numbers of the lens that went farther than its step would have it: fx by +4.1 σ."""
    return [
        f"{name} {shift['shift']:+.1f} σ"
        for name, shift in camera["lens"].items()
        if shift["shift"] is not None and abs(shift["shift"]) > LENS_SHIFT
    ]


def farthest_shift(camera: dict[str, Any]) -> float:
    """σ of the lens step by which the number of the lens went that went farthest."""
    return max((abs(shift["shift"] or 0.0) for shift in camera["lens"].values()), default=0.0)


def _picture(desk: Desk, camera: DeskCamera, click: adjust_clicks.Clicked | None) -> tuple[str, bool]:
    """Digest of the picture in which it was clicked, and whether the desk has that itself."""
    if click is None or click.source in {adjust_clicks.GROUND, adjust_clicks.KEPT}:
        return camera.full_digest, True
    if desk.dataset is None or not click.frame.isdecimal():
        return "", False
    rows = Image.objects.filter(
        frame__dataset=desk.dataset, frame__number=int(click.frame), camera__name=camera.name
    )
    return rows.values_list("full_digest", flat=True).first() or "", False
