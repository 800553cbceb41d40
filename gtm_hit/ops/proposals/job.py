"""Proposing as a job: asked for by a person, or begun when frames arrive and batches are cut."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from django.conf import settings
from django.contrib.auth.models import User
from django.utils.translation import gettext as _

from gtm_hit.models import Dataset, Frame, Image, Job, ProposalRun
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import Progress, no_progress, steps
from gtm_hit.ops.proposals import detectors, looking, runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.proposing import Proposed, propose
from gtm_hit.vision.detectors import Params

# A file's people and a model's own places are not asked for by method: they come of what is asked.
METHODS = [name for name in ProposalRun.Method.values if name not in ("file", "located")]


@dataclass(frozen=True)
class Order:
    """What to propose with. `use`: annotators see its people from the first frame on."""

    method: str = ProposalRun.Method.COVER.value
    detector: str = detectors.BUILT_IN
    use: bool = True


class ProposingFailed(queue.JobError):
    """Nothing could be proposed; says why."""


def start(dataset: Dataset, order: Order, user: User | None = None) -> Job:
    """Queue it; the job under way when it is the same. Raises ProposalError."""
    if order.method not in METHODS:
        raise ProposalError(_("There is no method %(name)s.") % {"name": order.method})
    if order.detector not in detectors.choices():
        raise ProposalError(_("There is no detector %(name)s on this server.") % {"name": order.detector})
    if not _has_pictures(dataset):
        raise ProposalError(_("The dataset has no pictures to look at."))
    return queue.create_once(Job.Kind.PROPOSE, dataset, asdict(order), user)


def start_by_itself(dataset: Dataset) -> Job | None:
    """For frames that came or were cut into batches: people are there before the annotator comes.

    In the way that is in use; nothing where the operator switched it off.
    """
    if not settings.PROPOSE_AUTOMATICALLY or not _has_pictures(dataset):
        return None
    run = ProposalRun.objects.filter(dataset=dataset, in_use=True).first()
    if run is None:
        return start(dataset, Order())
    asked = run.parameters.get("asked", run.method)
    detector = run.parameters.get("detector")
    if asked not in METHODS or detector not in detectors.choices() or not _left(run):
        return None  # a file says nothing about new frames, and what a command named is for commands
    return start(dataset, Order(asked, detector))


def _left(run: ProposalRun) -> bool:
    frames = Frame.objects.filter(dataset=run.dataset_id)
    return frames.exclude(proposal_frames__run=run).exists()


def _has_pictures(dataset: Dataset) -> bool:
    return Image.objects.filter(frame__dataset=dataset).exists()


def do(
    dataset: Dataset,
    order: Order,
    progress: Progress = no_progress,
    user: User | None = None,
    params: Params | None = None,
) -> tuple[ProposalRun, Proposed]:
    """Look at every frame that is still to be looked at in this way. Raises ProposalError.

    `params` are for detectors written in Python.
    """
    looker = looking.looker(dataset, order.method, order.detector, params)
    told = {**looker.settings, "asked": order.method, "detector": order.detector}
    if params:
        told["params"] = dict(params)
    run = runs.find_or_make(dataset, looker.method, looker.model, told, user)
    if order.use:
        runs.use(run)
    return run, propose(run, looker, progress)


def run(mine: queue.Run) -> dict[str, Any]:
    """The operation of a job. A worker that takes it up again goes on with the frame it was killed at."""
    dataset = mine.job.dataset
    if dataset is None:
        raise ProposingFailed("The dataset is no longer there.")
    order = Order(**mine.job.parameters)
    if order.detector not in detectors.choices():  # it was when this was asked for
        raise ProposingFailed(f"The detector {order.detector} is no longer offered by this server.")
    try:
        made, proposed = do(dataset, order, steps(mine), mine.job.created_by)
    except ProposalError as error:
        raise ProposingFailed(str(error)) from error
    return {"run": made.pk, **asdict(proposed)}
