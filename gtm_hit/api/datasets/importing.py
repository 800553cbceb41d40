"""Datasets and annotations in: from what lies on the server, or an archive sent here before."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from django.utils.translation import gettext as _
from drf_spectacular.utils import OpenApiExample, extend_schema
from rest_framework import exceptions, serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.parsing import BoundedMultiPartParser
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import (
    READS,
    WRITES,
    StaffView,
    answers,
    caller,
    dataset_or_404,
    invalid,
)
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.formats.problems import FormatError, ProblemList
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.models import ApiToken, Dataset
from gtm_hit.models.dataset import name_validator
from gtm_hit.ops.access.desks import desks_of
from gtm_hit.ops.access.jobs import NOT_YOURS, may_import
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.calibration.cameras import UNITS
from gtm_hit.ops.datasets import job as import_jobs
from gtm_hit.ops.datasets.options import PRESETS, ImportOptions, scene
from gtm_hit.ops.desk import placing
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.files import sources
from gtm_hit.ops.layers import job as annotation_import
from gtm_hit.ops.layers.findings import Kind
from gtm_hit.ops.layers.reading import READERS

WHOLE: dict[str, Any] = {"min_value": 1, "max_value": LARGEST, "required": False}


class SourceSerializer(serializers.Serializer[Any]):
    key = serializers.CharField(help_text="what imports are started with")
    archive = serializers.BooleanField(source="is_archive")


class SourcesSerializer(serializers.Serializer[Any]):
    results = SourceSerializer(many=True)


class FiniteField(serializers.FloatField):
    """What JSON can hold again when the job is written down."""

    def to_internal_value(self, data: Any) -> float:
        try:
            value = super().to_internal_value(data)
        except OverflowError:
            value = math.inf
        if not math.isfinite(value):
            self.fail("invalid")
        return value


class SceneValuesSerializer(serializers.Serializer[Any]):
    """What no file states; the dataset, the preset or a default give what is left out."""

    columns = serializers.IntegerField(**WHOLE)
    rows = serializers.IntegerField(**WHOLE)
    step = FiniteField(required=False, help_text="metres")
    origin_x = FiniteField(required=False, help_text="metres")
    origin_y = FiniteField(required=False, help_text="metres")
    cylinder_radius = FiniteField(required=False, help_text="metres")
    cylinder_height = FiniteField(required=False, help_text="metres")
    foot_rule = serializers.ChoiceField(choices=[rule.value for rule in FootRule], required=False)
    frame_rate = FiniteField(required=False, help_text="frame numbers per second")
    frame_step = serializers.IntegerField(**WHOLE)


class SceneSerializer(serializers.Serializer[Any]):
    """What every import of a dataset is told besides its files."""

    source = serializers.CharField(  # type: ignore[assignment]
        max_length=300, help_text="a key from /sources/ or /uploads/"
    )
    slug = serializers.SlugField(max_length=80, help_text="an existing dataset gets the frames it lacks")
    name = serializers.CharField(max_length=200, default="", allow_blank=True)
    preset = serializers.ChoiceField(choices=sorted(PRESETS), allow_null=True, default=None)
    tvec_unit = serializers.ChoiceField(choices=list(UNITS), allow_null=True, default=None)
    values = SceneValuesSerializer(default=dict)
    alpha = FiniteField(
        default=None,
        allow_null=True,
        min_value=0,
        max_value=1,
        help_text="where the lens is taken out, 0: no pixel stays black, 1: nothing seen is lost; "
        "null: the camera matrix of the files",
    )


class ImportSerializer(SceneSerializer):
    layer = serializers.CharField(max_length=80, default="imported", validators=[name_validator])
    hidden_layer = StrictBooleanField(default=False)
    undistort = StrictBooleanField(default=False)
    keep_all_frames = StrictBooleanField(default=False)
    desk = serializers.SlugField(
        max_length=80, required=False, help_text="a calibration desk whose cameras are used instead of a file"
    )


class ImportAnnotationsSerializer(serializers.Serializer[Any]):
    source = serializers.CharField(  # type: ignore[assignment]
        max_length=300, help_text="a key from /sources/ or /uploads/"
    )
    format = serializers.ChoiceField(choices=sorted(READERS))
    layer = serializers.CharField(max_length=120, validators=[name_validator], help_text="of the new layer")
    drop = serializers.ListField(
        child=serializers.ChoiceField(choices=[kind.value for kind in Kind]), default=list, max_length=10
    )
    hidden = StrictBooleanField(default=False, help_text="never shown to workers")


class UploadSerializer(serializers.Serializer[Any]):
    file = serializers.FileField(help_text="a zip of a dataset, or annotations as one file or a zip")


def source_named(request: Request, key: str) -> sources.Source:
    found = sources.source_of(key, caller(request))
    if found is None:
        raise invalid("source", _("There is no such source; see /api/v1/sources/."))
    return found


def refused(place: str, error: FormatError) -> exceptions.ValidationError:
    return exceptions.ValidationError({place: [str(problem) for problem in error.problems]})


def cameras_of_desk(request: Request, slug: str) -> str:
    """A file of its cameras, for an import to read."""
    desk = desks_of(caller(request)).filter(slug=slug).first()
    if desk is None:
        raise invalid("desk", _("There is no such desk; see /api/v1/calibration-desks/."))
    try:
        return str(placing.cameras_file(desk))
    except DeskError as error:
        raise invalid("desk", error) from error


def refuse_impossible(options: dict[str, Any]) -> None:
    """`options` are fields of ImportOptions, but for the folder: what they contradict is found at once."""
    existing = Dataset.objects.filter(slug=options["slug"]).first()
    problems = ProblemList("")
    try:
        scene(ImportOptions(folder=Path(), **options), existing, problems)
        problems.raise_if_any()
    except FormatError as error:
        reasons = [problem.reason for problem in error.problems]
        raise exceptions.ValidationError({"values": reasons}) from error


class Sources(StaffView):
    read_role = Role.MAINTAINER
    everywhere = True

    @extend_schema(
        operation_id="sources",
        summary="Folders and archives imports can be started from",
        responses=answers(200, SourcesSerializer, READS),
    )
    def get(self, request: Request) -> Response:
        return Response(SourcesSerializer({"results": sources.offered(caller(request))}).data)


class ArchiveParser(BoundedMultiPartParser):
    def most_bytes(self) -> int:
        return sources.most_bytes()


class Uploads(StaffView):
    parser_classes = [ArchiveParser]
    write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.IMPORT

    @extend_schema(
        operation_id="upload",
        summary="Send an archive to import from",
        description="Kept until it is imported, for a week at most. Nothing is imported yet.",
        request={"multipart/form-data": UploadSerializer},
        responses=answers(201, SourceSerializer, WRITES),
    )
    def post(self, request: Request) -> Response:
        file = valid(UploadSerializer(data=request.data))["file"]
        try:
            kept = annotation_import.keep(file)
        except FormatError as error:
            raise refused("file", error) from error
        return Response(SourceSerializer(kept).data, status=201)


class Imports(StaffView):
    write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.IMPORT

    @extend_schema(
        operation_id="start_import",
        summary="Import a dataset, or frames it does not have yet",
        description="Answers with the job. A job's `message` lists everything that is not right.",
        request=ImportSerializer,
        responses=answers(202, JobShape, WRITES),
        examples=[
            OpenApiExample(
                "as published",
                {"source": "incoming/MultiviewX", "slug": "multiviewx", "preset": "multiviewx"},
                request_only=True,
            )
        ],
    )
    def post(self, request: Request) -> Response:
        options = valid(ImportSerializer(data=request.data))
        if not may_import(caller(request), options["slug"]):
            raise invalid("slug", NOT_YOURS % {"slug": options["slug"]})
        source = source_named(request, options.pop("source"))
        options["values"] = dict(options["values"])
        desk = options.pop("desk", None)
        refuse_impossible(options)
        if desk is not None:
            options["calibrations"] = cameras_of_desk(request, desk)
        return started(import_jobs.start_import(source, options, caller(request)))


class AnnotationImports(StaffView):
    write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.IMPORT

    @extend_schema(
        operation_id="import_annotations",
        summary="Import annotations of another program as a new layer",
        request=ImportAnnotationsSerializer,
        responses=answers(202, JobShape, WRITES),
        examples=[
            OpenApiExample(
                "a detector's",
                {"source": "uploads/found-1a2b3c4d.zip", "format": "csv", "layer": "detector"},
                request_only=True,
            )
        ],
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(ImportAnnotationsSerializer(data=request.data))
        source = source_named(request, wanted["source"])
        drop = [Kind(name) for name in wanted["drop"]]
        try:
            job = annotation_import.start(
                dataset, source, wanted["format"], wanted["layer"], drop, wanted["hidden"], caller(request)
            )
        except annotation_import.AnnotationImportError as error:
            raise invalid("layer", error) from error
        return started(job)
