"""Adjusting as a job: written down every few steps, so whoever takes it up goes on where it was left.

What comes out depends on the input alone; the same input finds the same row, finished or under way.
"""

from __future__ import annotations

import time
from typing import Any

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import Max, QuerySet

from gtm_hit.calibration.adjustment import telling
from gtm_hit.calibration.adjustment.adjusting import Adjustment, Step, adjust
from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.report import report_of
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.calibration.adjustment.state import State
from gtm_hit.models import Desk, DeskAdjustment, Job
from gtm_hit.ops.desk import adjust_inputs, poses
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.adjust_inputs import FEWEST, Inputs
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.jobs import queue

SECONDS_BETWEEN_STATES = 1.0


def start(desk: Desk, choices: Choices, user: User | None = None) -> Job:
    """Begin, or go on where the same adjustment was stopped. Raises DeskError."""
    refuse_too_few(desk)
    adjust_inputs.gather(desk, choices)
    parameters = {"desk": desk.slug, "choices": choices.as_json()}
    return queue.create_once(Job.Kind.ADJUST, desk.dataset, parameters, user)


def refuse_too_few(desk: Desk) -> None:
    free = adjust_inputs.shared(desk).free
    if free < FEWEST:
        raise DeskError(
            f"There is nothing to adjust: {free} points are seen by two cameras or more, {FEWEST} are the "
            "least. Keep more correspondences on Check, or bring a file of clicks."
        )


def jobs_of(desk: Desk) -> QuerySet[Job]:
    """The newest first."""
    found = Job.objects.filter(kind=Job.Kind.ADJUST, parameters__desk=desk.slug)
    return found.order_by("-created_at", "-pk")


def run(mine: queue.Run) -> dict[str, Any]:
    parameters = mine.job.parameters
    desk = Desk.objects.filter(slug=parameters["desk"]).first()
    if desk is None:
        raise queue.JobError("The desk is no longer there.")
    choices = Choices.of_json(parameters["choices"])
    try:
        inputs = adjust_inputs.gather(desk, choices)
        row = _row(desk, choices, inputs, mine.job.created_by)
        if row.report is None:
            _finish(mine, row, inputs, _adjusted(mine, row, choices, inputs))
    except (DeskError, AdjustmentError) as error:
        raise queue.JobError(str(error)) from error
    return {"number": row.number, "cost": (row.report or {}).get("cost")}


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


def _adjusted(mine: queue.Run, row: DeskAdjustment, choices: Choices, inputs: Inputs) -> Adjustment:
    def progress(step: Step) -> None:
        where = f"pass {step.pass_number} of {step.passes}" if step.passes > 1 else "adjusting"
        mine.report(0, 0, f"{where}, step {step.number}: cost {step.cost:,.1f}")

    state = State.of_json(row.state) if row.state else None
    while True:
        until = time.monotonic() + SECONDS_BETWEEN_STATES
        result = adjust(
            inputs.problem,
            Variant(choices.variant),
            choices.settings,
            progress,
            lambda until=until: time.monotonic() > until,  # type: ignore[misc]
            state,
        )
        state = result.state
        with transaction.atomic():
            mine.keep()  # whoever lost the job writes nothing
            DeskAdjustment.objects.filter(pk=row.pk).update(state=state.as_json())
        if result.finished:
            return result


def _finish(mine: queue.Run, row: DeskAdjustment, inputs: Inputs, result: Adjustment) -> None:
    report = report_of(result)
    told = telling.content(result, report)
    for each in told["worst"]:
        points = inputs.measured if each["measured"] else inputs.free
        each["source"], each["point"] = points[each["point"]]
    told["notices"] = [*inputs.notices, *told["notices"]]
    beginnings: dict[str, Any] = inputs.snapshot["cameras"]
    row.report = told
    row.cameras = {
        view.name: {
            "number": row.number,
            "lens": {"matrix": view.lens.matrix.tolist(), "distortion": view.lens.distortion.tolist()},
            "pose": {"rvec": view.rvec.tolist(), "tvec": view.tvec.tolist()},
            "from": beginnings[view.name],
        }
        for view in result.views
    }
    for shown, view in zip(told["cameras"], result.views, strict=True):
        shown["centre_before"] = _centre(inputs, view.name)
    with transaction.atomic():
        mine.keep()
        row.save(update_fields=["report", "cameras"])


def _centre(inputs: Inputs, name: str) -> list[float]:
    view = next(each for each in inputs.problem.views if each.name == name)
    return [poses.number(value) or 0.0 for value in view.camera().centre.tolist()]
