"""Long work: how far it is, stopping it, doing it again, and the files it made."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from django.db.models import QuerySet
from django.http import FileResponse, Http404
from django.urls import get_script_prefix
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiExample, extend_schema, extend_schema_field, extend_schema_serializer
from rest_framework import serializers
from rest_framework.exceptions import APIException
from rest_framework.generics import ListAPIView
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.refusals import refusal
from gtm_hit.api.common.staff import (
    ASKS,
    READS,
    Conflict,
    Pages,
    StaffView,
    answers,
    asked,
    caller,
)
from gtm_hit.models import ApiToken, Job
from gtm_hit.ops import overview
from gtm_hit.ops.access.jobs import jobs_of
from gtm_hit.ops.access.roles import CARES
from gtm_hit.ops.exports import expiry, exporting
from gtm_hit.ops.exports.expiry import Removed
from gtm_hit.ops.jobs import queue as job_ops

GONE = {
    expiry.Removed.EXPIRED: gettext_lazy("This export has expired; retry the job to make it again."),
    expiry.Removed.DELETED: gettext_lazy(
        "The files of this export were deleted; retry the job to make it again."
    ),
}

# Who may start such a job may stop it and start it again.
SCOPES = {
    Job.Kind.EXPORT_LAYER: ApiToken.Scope.RELEASE,
    Job.Kind.MAKE_RELEASE: ApiToken.Scope.RELEASE,
    Job.Kind.SEND_OUTBOX: ApiToken.Scope.WORK,
    Job.Kind.STITCH: ApiToken.Scope.WORK,
}


@extend_schema_serializer(
    examples=[
        OpenApiExample(
            "a finished release",
            {
                "id": 41,
                "dataset": "square",
                "kind": "make_release",
                "state": "done",
                "done": 100,
                "total": 100,
                "message": "",
                "result": {"release": 3, "counts": {"frames": 400, "people": 313}},
                "attempts": 1,
                "cancel_requested": False,
                "created_by": "ada",
                "created_at": "2026-11-02T10:00:00Z",
                "started_at": "2026-11-02T10:00:01Z",
                "finished_at": "2026-11-02T10:00:09Z",
                "download": None,
            },
            response_only=True,
        )
    ]
)
class JobShape(serializers.ModelSerializer[Job]):
    dataset = serializers.CharField(source="dataset.slug", default=None, allow_null=True)
    result = serializers.DictField()
    created_by = serializers.CharField(source="created_by.username", default=None, allow_null=True)
    download = serializers.SerializerMethodField()
    expires_at = serializers.SerializerMethodField()
    removed = serializers.SerializerMethodField()

    class Meta:
        model = Job
        fields = [
            *("id", "dataset", "kind", "state", "done", "total", "message", "result", "attempts"),
            *("cancel_requested", "created_by", "created_at", "started_at", "finished_at", "download"),
            *("expires_at", "removed"),
        ]

    @extend_schema_field(serializers.CharField(allow_null=True, help_text="address of an export's zip"))
    def get_download(self, job: Job) -> str | None:
        return f"{get_script_prefix()}api/v1/jobs/{job.pk}/download/" if exporting.made_files(job) else None

    @extend_schema_field(
        serializers.DateTimeField(allow_null=True, help_text="when an export's files will be removed")
    )
    def get_expires_at(self, job: Job) -> datetime | None:
        return expiry.expires_at(job)

    @extend_schema_field(
        serializers.ChoiceField(
            choices=list(Removed), allow_null=True, help_text="why an export's files are gone"
        )
    )
    def get_removed(self, job: Job) -> str | None:
        return expiry.removed(job)


class JobsQuery(serializers.Serializer[Any]):
    dataset = serializers.SlugField(max_length=80, required=False)
    kind = serializers.ChoiceField(choices=Job.Kind.choices, required=False)
    state = serializers.ChoiceField(choices=Job.State.choices, required=False)


def job_or_404(request: Request, pk: int) -> Job:
    found = jobs_of(caller(request)).filter(pk=pk).first()
    if found is None:
        raise Http404
    return found


def started(job: Job) -> Response:
    """The answer to whoever asked for long work."""
    return Response(JobShape(overview.jobs().get(pk=job.pk)).data, status=202)


class Jobs(StaffView, ListAPIView[Job]):
    read_role = CARES
    queryset = Job.objects.none()
    serializer_class = JobShape
    pagination_class = Pages

    def get_queryset(self) -> QuerySet[Job]:
        wanted = asked(self.request, JobsQuery)
        if "dataset" in wanted:
            wanted["dataset__slug"] = wanted.pop("dataset")
        return jobs_of(caller(self.request)).filter(**wanted).order_by("-created_at", "-pk")

    @extend_schema(
        operation_id="jobs",
        summary="Jobs, the newest first",
        parameters=[JobsQuery],
        responses=answers(200, JobShape(many=True), ASKS),
    )
    def get(self, request: Request, *args: Any, **kwargs: Any) -> Response:
        return super().get(request, *args, **kwargs)


class OneJob(StaffView):
    read_role = CARES

    @extend_schema(operation_id="job", summary="A job", responses=answers(200, JobShape, READS))
    def get(self, request: Request, pk: int) -> Response:
        return Response(JobShape(job_or_404(request, pk)).data)


class Gone(APIException):
    status_code = 410
    default_code = "removed"


class NoFiles(Conflict):
    default_code = "no_files"


class JobAction(StaffView):
    write_role = CARES  # and of the jobs only those that one could start

    @property
    def write_scope(self) -> ApiToken.Scope:  # type: ignore[override]
        kind = Job.objects.filter(pk=self.kwargs["pk"]).values_list("kind", flat=True).first()
        return SCOPES.get(Job.Kind(kind), ApiToken.Scope.IMPORT) if kind else ApiToken.Scope.READ


class CancelJob(JobAction):
    @extend_schema(
        operation_id="cancel_job",
        summary="Stop a job",
        description="A waiting job ends at once, a running one at its next step; a finished one stays.",
        request=None,
        responses=answers(200, JobShape, READS),
    )
    def post(self, request: Request, pk: int) -> Response:
        job_ops.cancel(job_or_404(request, pk))
        return Response(JobShape(job_or_404(request, pk)).data)


class RetryJob(JobAction):
    @extend_schema(
        operation_id="retry_job",
        summary="Do the same again, as a new job",
        request=None,
        responses=answers(202, JobShape, {**READS, 409: refusal("under_way")}),
    )
    def post(self, request: Request, pk: int) -> Response:
        job = job_or_404(request, pk)
        if not job.finished:
            raise Conflict(_("This job is still under way."))
        return started(job_ops.retry(job, caller(request)))


class DeleteFiles(JobAction):
    @extend_schema(
        operation_id="delete_job_files",
        summary="Remove the files of a finished export",
        description="The job stays and can be done again. Releases cannot be removed.",
        request=None,
        responses=answers(200, JobShape, {**READS, 409: refusal("no_files")}),
    )
    def post(self, request: Request, pk: int) -> Response:
        if not expiry.delete(job_or_404(request, pk)):
            raise NoFiles(_("This job has no files to delete."))
        return Response(JobShape(job_or_404(request, pk)).data)


class Download(StaffView):
    """Archives are no JSON: a client that accepts zip only is right here."""

    def perform_content_negotiation(self, request: Request, force: bool = False) -> Any:
        return super().perform_content_negotiation(request, force=True)


class DownloadJob(Download):
    read_role = CARES

    @extend_schema(
        operation_id="download_job",
        summary="The zip of a finished export",
        responses={
            (200, "application/zip"): OpenApiTypes.BINARY,
            **READS,
            410: refusal("removed; the job can be done again"),
        },
    )
    def get(self, request: Request, pk: int) -> FileResponse:
        job = job_or_404(request, pk)
        if reason := expiry.removed(job):
            raise Gone(GONE[reason])
        export = exporting.finished(job)
        if export is None:
            raise Http404
        return FileResponse(export.archive.open("rb"), as_attachment=True, filename=export.archive_name)
