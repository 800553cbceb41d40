"""Adjusting as a job."""

from __future__ import annotations

from typing import Any

from django.contrib.auth.models import User
from django.db.models import QuerySet
from django.utils import timezone

from gtm_hit.calibration.adjustment.adjusting import Step
from gtm_hit.models import Desk, Job
from gtm_hit.ops.desk import adjust_inputs, adjust_solving
from gtm_hit.ops.desk.adjust_choices import Choices
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.jobs import queue


def start(desk: Desk, choices: Choices, user: User | None = None) -> Job:
    """Begin, or go on where the same adjustment was stopped. Raises DeskError."""
    adjust_solving.refuse_too_few(desk)
    adjust_inputs.gather(desk, choices)
    parameters = {"desk": desk.slug, "choices": choices.as_json()}
    return queue.create_once(Job.Kind.ADJUST, desk.dataset, parameters, user)


def jobs_of(desk: Desk) -> QuerySet[Job]:
    """The newest first."""
    found = Job.objects.filter(kind=Job.Kind.ADJUST, parameters__desk=desk.slug)
    return found.order_by("-created_at", "-pk")


def run(mine: queue.Run) -> dict[str, Any]:
    parameters = mine.job.parameters
    desk = Desk.objects.filter(slug=parameters["desk"]).first()
    if desk is None:
        raise queue.JobError("The desk is no longer there.")

    def progress(step: Step) -> None:
        mine.report(0, 0, in_words(step))

    def hold() -> None:
        mine.keep(heartbeat_at=timezone.now())  # raises where another worker has the job by now

    choices = Choices.of_json(parameters["choices"])
    try:
        found = adjust_solving.solve(desk, choices, mine.job.created_by, progress, hold)
    except DeskError as error:
        raise queue.JobError(str(error)) from error
    return {"number": found.number}


def in_words(step: Step) -> str:
    """How many steps it takes nobody knows before; the cost tells how it goes."""
    where = f"pass {step.pass_number} of {step.passes}, " if step.passes > 1 else ""
    return f"{where}step {step.number}: cost {step.cost:,.1f}"
