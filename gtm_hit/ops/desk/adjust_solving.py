"""Adjusting a desk, written down every few steps, so whoever takes it up goes on where it was left.

What comes out depends on the input alone; the same input finds the same row, finished or under way.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import count

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import Max

from gtm_hit.calibration.adjustment import telling
from gtm_hit.calibration.adjustment.adjusting import Adjustment, Progress, adjust
from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.problem import View
from gtm_hit.calibration.adjustment.report import report_of
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.calibration.adjustment.state import State
from gtm_hit.models import Desk, DeskAdjustment
from gtm_hit.ops.desk import adjust_inputs
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.adjust_inputs import FEWEST, Inputs
from gtm_hit.ops.desk.errors import DeskError

SECONDS_BETWEEN_STATES = 1.0

Hold = Callable[[], object]  # called before anything is written: raises where somebody else does it by now


def refuse_too_few(desk: Desk) -> None:
    """Raises DeskError where there are not enough shared points to adjust with."""
    free = adjust_inputs.shared(desk).free
    if free < FEWEST:
        are = "point is" if free == 1 else "points are"
        raise DeskError(
            f"There is nothing to adjust: {free} {are} seen by two cameras or more, {FEWEST} are the least. "
            "Keep more correspondences on Check, or bring a file of clicks."
        )


def solve(
    desk: Desk,
    choices: Choices,
    user: User | None = None,
    progress: Progress | None = None,
    hold: Hold = lambda: None,
) -> DeskAdjustment:
    """The finished result. What `progress` raises stops it; it goes on from there when called again.

    Raises DeskError.
    """
    refuse_too_few(desk)
    inputs = adjust_inputs.gather(desk, choices)
    row = _row(desk, choices, inputs, user)
    if row.report is None:
        try:
            _finish(row, inputs, _adjusted(row, choices, inputs, progress, hold), hold)
        except AdjustmentError as error:
            raise DeskError(str(error)) from error
    return row


def _row(desk: Desk, choices: Choices, inputs: Inputs, user: User | None) -> DeskAdjustment:
    with transaction.atomic():
        Desk.objects.select_for_update().get(pk=desk.pk)
        found = desk.adjustments.filter(of=inputs.digest).first()
        if found is not None:
            return found
        last = desk.adjustments.aggregate(last=Max("number"))["last"] or 0
        return DeskAdjustment.objects.create(
            desk=desk,
            number=last + 1,
            of=inputs.digest,
            choices=choices.as_json(),
            inputs=inputs.snapshot,
            created_by=user,
        )


def _adjusted(
    row: DeskAdjustment, choices: Choices, inputs: Inputs, progress: Progress | None, hold: Hold
) -> Adjustment:
    state = State.of_json(row.state) if row.state else None
    variant, settings = Variant(choices.variant), choices.settings
    while True:
        stop = _after(SECONDS_BETWEEN_STATES)
        result = adjust(inputs.problem, variant, settings, progress, stop, state)
        state = result.state
        with transaction.atomic():
            hold()
            DeskAdjustment.objects.filter(pk=row.pk).update(state=state.as_json())
        if result.finished:
            return result


def _after(seconds: float) -> Callable[[], bool]:
    """Not before one step is made, however long it takes to begin: each turn leads on."""
    until = time.monotonic() + seconds
    asked = count()
    return lambda: next(asked) > 0 and time.monotonic() > until


def _finish(row: DeskAdjustment, inputs: Inputs, result: Adjustment, hold: Hold) -> None:
    told = telling.content(result, report_of(result))
    for each in told["worst"]:
        points = inputs.measured if each["measured"] else inputs.free
        each["source"], each["point"] = points[each["point"]]
    told["notices"] = [*inputs.notices, *told["notices"]]
    for camera, was in zip(told["cameras"], inputs.problem.views, strict=True):
        camera["centre_before"] = was.camera().centre.tolist()
    row.report = told
    row.cameras = {view.name: _found(row, view, inputs) for view in result.views}
    with transaction.atomic():
        hold()
        row.save(update_fields=["report", "cameras"])


def _found(row: DeskAdjustment, view: View, inputs: Inputs) -> dict[str, object]:
    return {
        "number": row.number,
        "lens": {"matrix": view.lens.matrix.tolist(), "distortion": view.lens.distortion.tolist()},
        "pose": {"rvec": view.rvec.tolist(), "tvec": view.tvec.tolist()},
        "from": inputs.snapshot["cameras"][view.name],
    }
