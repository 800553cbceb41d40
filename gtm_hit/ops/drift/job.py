"""Remembering marks and comparing with them as a job."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import asdict
from typing import Any

from django.contrib.auth.models import User
from django.utils.translation import gettext as _

from gtm_hit.models import Dataset, Job
from gtm_hit.ops.drift import checking, remembering
from gtm_hit.ops.drift.pictures import DriftRefused, Span, frames_in
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import steps


def start(dataset: Dataset, span: Span, remember: bool = False, user: User | None = None) -> Job:
    """Queue it; the job under way when it is the same. Raises DriftRefused for what is known to fail."""
    remembering.in_place(dataset)
    frames_in(dataset, span)
    if not remember and not remembering.remembered(dataset).exists():
        raise DriftRefused(_(checking.NOTHING_REMEMBERED))
    return queue.create_once(Job.Kind.DRIFT, dataset, {**asdict(span), "remember": remember}, user)


def start_by_itself(dataset: Dataset, user: User | None = None) -> Job | None:
    """For a calibration just put in place that has no marks yet; nothing where there are no pictures."""
    if remembering.remembered(dataset).exists():
        return None
    with suppress(DriftRefused):
        return start(dataset, Span(), remember=True, user=user)
    return None


def run(mine: queue.Run) -> dict[str, Any]:
    dataset = mine.job.dataset
    if dataset is None:
        raise queue.JobError("The dataset is no longer there.")
    asked = dict(mine.job.parameters)
    remember, span, user = asked.pop("remember"), Span(**asked), mine.job.created_by
    try:
        if remember:
            rows = remembering.remember(dataset, span, steps(mine), user)
            return {"marks": {row.camera.name: row.count for row in rows}}
        found = checking.check_frames(dataset, span, steps(mine), user, mine.job)
    except DriftRefused as error:
        raise queue.JobError(str(error)) from error
    return {"check": found.pk, "warns": found.warns}
