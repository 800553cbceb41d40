"""What a person says of a click that an adjustment found far off: it is right, or it is not to be used."""

from __future__ import annotations

from django.contrib.auth.models import User

from gtm_hit.models import ClickDecision, Desk
from gtm_hit.ops.desk import adjust_clicks, edits
from gtm_hit.ops.desk.adjust_clicks import Clicked
from gtm_hit.ops.desk.adjust_results import PAGE
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.ops.desk.things import DECISION

WORDS = {"keep": "kept as it is", "drop": "dropped", "": "undecided again"}


def decide(desk: Desk, source: str, point: str, camera: str, decision: str, user: User | None = None) -> None:
    """`keep`, `drop`, or nothing to take that back; one step, to be undone. Raises DeskError."""
    if decision not in WORDS:
        raise DeskError(f"A click is kept or dropped, not “{decision}”.")
    key = (source, point, camera)
    click = next((each for each in adjust_clicks.all_clicks(desk) if each.key == key), None)
    if click is None:
        raise NotThere(f"There is no click on {point} in {camera} to adjust with.")
    value = [ClickDecision.Decision(decision).value, click.x, click.y] if decision else None
    what = f"{point} in {camera} {WORDS[decision]}"
    edits.edit(desk, PAGE, what, [(DECISION, list(key), value)], user)


def dropped(desk: Desk) -> list[Clicked]:
    """Clicks that are not adjusted with, though they are there."""
    clicks = adjust_clicks.all_clicks(desk)
    left_out = adjust_clicks.decided(desk, clicks).dropped
    return [click for click in clicks if click.key in left_out]
