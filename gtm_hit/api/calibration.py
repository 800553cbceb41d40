"""Another calibration for a dataset: compared box by box first, then put in its place by another request."""

from __future__ import annotations

from typing import Any

from django.contrib.auth.models import User
from django.http import Http404
from django.utils.translation import gettext as _
from drf_spectacular.utils import OpenApiExample, extend_schema, extend_schema_serializer
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.parsing import BoundedMultiPartParser
from gtm_hit.api.common.refusals import refusal, valid
from gtm_hit.api.common.staff import (
    READS,
    WRITES,
    Conflict,
    StaffView,
    answers,
    caller,
    dataset_or_404,
    invalid,
)
from gtm_hit.api.datasets.importing import refused
from gtm_hit.api.jobs import JobShape, job_or_404, started
from gtm_hit.formats.problems import FormatError
from gtm_hit.models import ApiToken, Dataset, Job
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.calibration.cameras import UNITS
from gtm_hit.ops.calibration.reading import MOST_BYTES, file_report, read_upload
from gtm_hit.ops.calibration.replacing import ReplacementError


class CalibrationParser(BoundedMultiPartParser):
    def most_bytes(self) -> int:
        return MOST_BYTES


class CalibrationSerializer(serializers.Serializer[Any]):
    """`file` or `version`."""

    file = serializers.FileField(
        required=False, help_text="cameras.json, or a zip of a folder of calibrations"
    )
    version = serializers.IntegerField(
        required=False, min_value=1, max_value=LARGEST, help_text="one the dataset had before"
    )
    tvec_unit = serializers.ChoiceField(
        choices=list(UNITS), default="m", help_text="of tvec in XML and YAML; cameras.json is in metres"
    )

    def validate(self, given: dict[str, Any]) -> dict[str, Any]:
        if ("file" in given) == ("version" in given):
            raise invalid("file", _("Send either a file or the number of a version."))
        return given


class MovedInCameraSerializer(serializers.Serializer[Any]):
    """Boxes of one camera; a box moves by the largest distance one of its edges goes."""

    name = serializers.CharField()
    compared = serializers.IntegerField(help_text="boxes visible before and after")
    moved = serializers.IntegerField(help_text="those among them that move")
    median = serializers.FloatField(help_text="pixels")
    p95 = serializers.FloatField(help_text="pixels")
    max = serializers.FloatField(help_text="pixels")
    appeared = serializers.IntegerField(help_text="boxes that become visible")
    vanished = serializers.IntegerField(help_text="boxes that are visible no longer")


class MovedBoxSerializer(serializers.Serializer[Any]):
    shift = serializers.IntegerField(help_text="pixels")
    layer = serializers.CharField()
    frame = serializers.IntegerField(help_text="frame number")
    person = serializers.IntegerField()
    camera = serializers.IntegerField(help_text="index")
    before = serializers.ListField(child=serializers.IntegerField(), help_text="xmin, ymin, xmax, ymax")
    after = serializers.ListField(child=serializers.IntegerField(), help_text="xmin, ymin, xmax, ymax")


@extend_schema_serializer(
    examples=[
        OpenApiExample(
            "one camera whose image centre was corrected by 7 pixels",
            {
                "job": 17,
                "annotations": 9518,
                "cameras": [
                    {
                        "name": "C1",
                        "compared": 5100,
                        "moved": 5100,
                        "median": 7,
                        "p95": 7,
                        "max": 8,
                        "appeared": 3,
                        "vanished": 0,
                    }
                ],
                "worst": [
                    {
                        "shift": 8,
                        "layer": "truth",
                        "frame": 0,
                        "person": 12,
                        "camera": 0,
                        "before": [1510, 139, 1561, 299],
                        "after": [1518, 139, 1569, 299],
                    }
                ],
                "confirmed_at": None,
                "calibration": None,
            },
            response_only=True,
        )
    ]
)
class CalibrationPreviewSerializer(serializers.Serializer[Any]):
    job = serializers.IntegerField()
    annotations = serializers.IntegerField(help_text="of all layers; their positions stay")
    cameras = MovedInCameraSerializer(many=True)
    worst = MovedBoxSerializer(many=True, help_text="boxes that move most")
    confirmed_at = serializers.DateTimeField(allow_null=True, help_text="when it was put in place")
    calibration = serializers.IntegerField(allow_null=True, help_text="the number it was put in place under")


class CannotConfirm(Conflict):
    default_code = "conflict"


class Calibrations(StaffView):
    parser_classes = [CalibrationParser]
    write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.IMPORT

    @extend_schema(
        operation_id="compare_calibration",
        summary="See what another calibration would move",
        description="Answers with a job of the kind `replace_calibration`. Nothing changes until what it "
        "found is confirmed.",
        request={"multipart/form-data": CalibrationSerializer},
        responses=answers(202, JobShape, WRITES),
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(CalibrationSerializer(data=request.data))
        if "version" in wanted:
            return started(self.back_to(dataset, wanted["version"], caller(request)))
        try:
            cameras = read_upload(dataset, wanted["file"], wanted["tvec_unit"])
        except FormatError as error:
            raise refused("file", error) from error
        file = wanted["file"]
        report = file_report(file.name, file.chunks(), wanted["tvec_unit"])
        return started(calibration_job.start(dataset, cameras, caller(request), file.name, report=report))

    def back_to(self, dataset: Dataset, number: int, user: User) -> Job:
        try:
            return calibration_job.start_version(dataset, number, user)
        except versions.UnknownVersion as error:
            raise invalid("version", error) from error


class OneCalibration(StaffView):
    read_role = Role.MAINTAINER

    @extend_schema(
        operation_id="calibration_preview",
        summary="Which boxes move, by how many pixels",
        description="Not found until its job is done.",
        responses=answers(200, CalibrationPreviewSerializer, READS),
    )
    def get(self, request: Request, slug: str, pk: int) -> Response:
        job = change_or_404(request, slug, pk)
        if job.state != Job.State.DONE:
            raise Http404
        return Response(CalibrationPreviewSerializer(seen(request, job)).data)


class ConfirmCalibration(StaffView):
    write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.IMPORT

    @extend_schema(
        operation_id="confirm_calibration",
        summary="Put a compared calibration in place",
        description="Once, and only while annotations and calibration are as they were when it was compared.",
        request=None,
        responses=answers(
            200, CalibrationPreviewSerializer, {**READS, 409: refusal("conflict: compare again")}
        ),
    )
    def post(self, request: Request, slug: str, pk: int) -> Response:
        job = change_or_404(request, slug, pk)
        try:
            calibration_job.confirm(job, caller(request))
        except ReplacementError as error:
            raise CannotConfirm(str(error)) from error
        return Response(CalibrationPreviewSerializer(seen(request, change_or_404(request, slug, pk))).data)


def change_or_404(request: Request, slug: str, pk: int) -> Job:
    job = job_or_404(request, pk)
    if job.kind != Job.Kind.REPLACE_CALIBRATION or job.dataset is None or job.dataset.slug != slug:
        raise Http404
    return job


def seen(request: Request, job: Job) -> dict[str, Any]:
    found = calibration_job.seen_by(caller(request), job)
    return {"confirmed_at": None, "calibration": None, **found, "job": job.pk}
