"""What a Celery worker does: ids in, one operation, progress on a row."""

from __future__ import annotations

from functools import partial
from typing import Any

from celery import shared_task
from celery.signals import worker_ready
from django.utils import timezone

from gtm_hit.crowd.prolific import connect
from gtm_hit.models import Job
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.datasets import job
from gtm_hit.ops.desk import adjust_job, lens_job
from gtm_hit.ops.drift import job as drift_job
from gtm_hit.ops.exports import expiry, exporting
from gtm_hit.ops.files import picture_cleanup, sources
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.layers import job as annotation_job
from gtm_hit.ops.layers import unfinished
from gtm_hit.ops.outbox import sending
from gtm_hit.ops.proposals import foregrounds
from gtm_hit.ops.proposals import job as proposal_job
from gtm_hit.ops.releases import releasing
from gtm_hit.ops.scores import computing
from gtm_hit.ops.stitching import running as stitching
from gtm_hit.ops.sync import job as sync_job
from gtm_hit.ops.sync import pictures as video_pictures
from gtm_hit.ops.work import assignments

OPERATIONS: dict[str, queue.Operation] = {
    Job.Kind.ADJUST: adjust_job.run,
    Job.Kind.DRIFT: drift_job.run,
    Job.Kind.EXPORT_LAYER: exporting.run,
    Job.Kind.IMPORT_DATASET: job.run_import,
    Job.Kind.IMPORT_VIDEOS: job.run_videos,
    Job.Kind.IMPORT_ANNOTATIONS: annotation_job.run,
    Job.Kind.MAKE_RELEASE: releasing.run,
    Job.Kind.PROPOSE: proposal_job.run,
    Job.Kind.REPLACE_CALIBRATION: calibration_job.run,
    Job.Kind.SOLVE_LENS: lens_job.run,
    Job.Kind.STITCH: stitching.run,
    Job.Kind.SYNC_VIDEOS: sync_job.run,
    Job.Kind.SEND_OUTBOX: partial(sending.run, connect=connect),
}


@shared_task
def run_job(job_id: int) -> None:
    queue.run(job_id, OPERATIONS)


@shared_task
def requeue_lost_jobs() -> None:
    queue.requeue_lost(timezone.now())
    exporting.remove_dead_partials()
    sources.remove_leftovers()


@shared_task
def expire_exports() -> None:
    expiry.expire(timezone.now())
    unfinished.remove_abandoned(timezone.now())


@shared_task
def remove_unused_pictures() -> None:
    picture_cleanup.remove_unused_pictures(timezone.now())
    video_pictures.remove_old(timezone.now())
    foregrounds.sweep()


@shared_task
def expire_leases() -> None:
    assignments.expire_leases(timezone.now())


@shared_task
def resume_outboxes() -> None:
    sending.resume(timezone.now())


@shared_task
def score_assignment(assignment_id: int) -> None:
    computing.score_assignment(assignment_id)


@shared_task
def recompute_scores() -> None:
    computing.recompute_all()


@worker_ready.connect
def look_for_lost_jobs(**kwargs: Any) -> None:
    """A worker that comes back looks at once for what was lost meanwhile."""
    requeue_lost_jobs.delay()
    expire_exports.delay()  # a machine that is on for an hour at a time has to come to it, too
    remove_unused_pictures.delay()
    resume_outboxes.delay()
