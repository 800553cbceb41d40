"""What can be compared: versions, desks that are complete, and what was compared but is not in place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from django.db.models import Q, QuerySet

from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Dataset, Desk, Job
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.desk import placing
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.errors import OperationError

DESK, JOB = "desk", "job"
JOBS_OFFERED = 10


class UnknownSide(OperationError, LookupError):
    """Nothing that can be compared has this name; says so."""


@dataclass(frozen=True)
class Side:
    """One of the two calibrations; `key` is how it is asked for."""

    key: str
    words: str
    cameras: Sequence[Camera]


@dataclass(frozen=True)
class Choice:
    key: str
    words: str


def choices(dataset: Dataset) -> list[Choice]:
    """Versions, the newest first, then drafts."""
    return [*_versions(dataset), *_desks(dataset), *_jobs(dataset)]


def side(dataset: Dataset, key: str) -> Side:
    """`N` is a version, `desk:NAME` what a desk has now, `job:J` what a comparison of boxes was asked for.

    Raises UnknownSide, UnknownVersion, and DeskError for a desk that something is missing of.
    """
    kind, _colon, name = key.rpartition(":")
    if kind == DESK and (desk := dataset.desks.filter(slug=name).first()):
        return Side(key, f"desk {name}", placing.cameras(desk))
    if kind == JOB and name.isdecimal() and (job := _comparisons(dataset).filter(pk=int(name)).first()):
        return Side(key, _words_of(job), calibration_job.cameras_of(job))
    if not kind and name.isdecimal():
        found = versions.version(dataset, int(name))
        return Side(key, f"version {name}", versions.cameras_in(found))
    raise UnknownSide(
        f"{dataset} has no calibration “{key}”. Give a version's number, desk:NAME or job:NUMBER."
    )


def key_of(job: Job) -> str:
    """Of what a comparison of boxes was asked for."""
    number = job.parameters.get("version")
    return f"{JOB}:{job.pk}" if number is None else str(number)


def _versions(dataset: Dataset) -> Iterator[Choice]:
    for each in versions.versions(dataset):
        used = ", in use" if each.pk == dataset.calibration_id else ""
        yield Choice(str(each.number), f"version {each.number}{used}: {each.source or 'unknown'}")


def _desks(dataset: Dataset) -> Iterator[Choice]:
    for desk in Desk.objects.filter(dataset=dataset):
        try:
            placing.cameras(desk)
        except DeskError:
            continue
        yield Choice(f"{DESK}:{desk.slug}", f"desk {desk.slug}, as it is now")


def _jobs(dataset: Dataset) -> Iterator[Choice]:
    open_ones = _comparisons(dataset).filter(result__confirmed_at__isnull=True)
    for job in open_ones.order_by("-pk")[:JOBS_OFFERED]:
        yield Choice(f"{JOB}:{job.pk}", _words_of(job))


def _comparisons(dataset: Dataset) -> QuerySet[Job]:
    """Of new numbers: going back compares with a version, which is there itself."""
    jobs = Job.objects.filter(
        dataset=dataset, kind=Job.Kind.REPLACE_CALIBRATION, parameters__has_key="cameras"
    )
    return jobs.filter(Q(parameters__version=None) | Q(parameters__version__isnull=True))


def _words_of(job: Job) -> str:
    return f"{job.parameters.get('source') or 'a calibration'}, compared in job {job.pk}"
