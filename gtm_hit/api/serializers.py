"""The shapes of requests and answers; the checks of annotations themselves are `ops.annotation_rules`'s."""

from __future__ import annotations

from typing import Any

from django.utils.translation import gettext as _
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema_field
from rest_framework import serializers

from gtm_hit.models import Annotation
from gtm_hit.ops.tutorial import Step

LARGEST = 2**31 - 2  # one more still fits PostgreSQL's integer


class AnnotationSerializer(serializers.Serializer[Any]):
    person = serializers.IntegerField(min_value=0)
    position = serializers.IntegerField(min_value=0)
    state = serializers.ChoiceField(choices=Annotation.State.choices)
    origin = serializers.ChoiceField(choices=Annotation.Origin.choices)
    height = serializers.FloatField(allow_null=True, help_text="metres; null: the dataset's cylinder")
    radius = serializers.FloatField(allow_null=True, help_text="metres; null: the dataset's cylinder")


@extend_schema_field(AnnotationSerializer(many=True))
class AnnotationsField(serializers.JSONField):
    """Passed on as sent, so that all problems of a frame are reported together with their places."""


class StrictBooleanField(serializers.BooleanField):
    """JSON's own true and false: "off" and 0 are mistakes of the sender."""

    def to_internal_value(self, data: Any) -> bool:
        if not isinstance(data, bool):
            raise serializers.ValidationError(_("Must be true or false."))
        return data


@extend_schema_field(OpenApiTypes.DOUBLE)
class NumberField(serializers.Field[Any, Any, Any, Any]):
    """Any JSON value: its bounds are checked with the annotations."""

    def to_internal_value(self, data: Any) -> Any:
        return data

    def to_representation(self, value: Any) -> Any:
        return value


class SaveSerializer(serializers.Serializer[Any]):
    save_id = serializers.UUIDField(help_text="chosen by the sender; the same again changes nothing")
    revision = serializers.IntegerField(
        min_value=0, max_value=LARGEST, help_text="the revision this edit started from"
    )
    annotations = AnnotationsField()
    done = StrictBooleanField(default=False)
    nobody = StrictBooleanField(default=False)
    seconds = NumberField(default=0.0, help_text="active seconds since the save before")


class FrameStateSerializer(serializers.Serializer[Any]):
    number = serializers.IntegerField()
    revision = serializers.IntegerField()
    annotations = AnnotationSerializer(many=True)
    done = serializers.BooleanField()
    nobody = serializers.BooleanField()
    saved_at = serializers.DateTimeField(allow_null=True)
    author = serializers.CharField()


class FrameStatesSerializer(serializers.Serializer[Any]):
    frames = FrameStateSerializer(many=True)


class RevisionSerializer(serializers.Serializer[Any]):
    revision = serializers.IntegerField()
    created_at = serializers.DateTimeField()
    author = serializers.CharField()
    people = serializers.IntegerField()
    done = serializers.BooleanField()


class HistorySerializer(serializers.Serializer[Any]):
    revisions = RevisionSerializer(many=True)


class ErrorSerializer(serializers.Serializer[Any]):
    code = serializers.CharField()
    message = serializers.CharField()
    details = serializers.JSONField(allow_null=True)


class FrameRangeSerializer(serializers.Serializer[Any]):
    """Query of a layer's frames."""

    count = serializers.IntegerField(min_value=1, max_value=50, default=50)

    def get_fields(self) -> dict[str, Any]:
        # `from` cannot be an attribute's name.
        start = serializers.IntegerField(min_value=0, max_value=LARGEST, default=0, help_text="frame number")
        return {"from": start, **super().get_fields()}


class RevisionQuerySerializer(serializers.Serializer[Any]):
    revision = serializers.IntegerField(min_value=0, max_value=LARGEST, required=False)


class SubmittedSerializer(serializers.Serializer[Any]):
    code = serializers.CharField()
    summary = serializers.DictField()


class CheckSerializer(serializers.Serializer[Any]):
    step = serializers.CharField(help_text=", ".join(step.value for step in Step))
    frame = serializers.IntegerField(min_value=0, max_value=LARGEST)
    annotations = AnnotationsField()

    def validate_step(self, value: str) -> Step:
        if value not in set(Step):
            raise serializers.ValidationError(_("Must be one of %(choices)s.") % {"choices": ", ".join(Step)})
        return Step(value)


class VerdictSerializer(serializers.Serializer[Any]):
    ok = serializers.BooleanField()
    message = serializers.CharField()


class TutorialDoneSerializer(serializers.Serializer[Any]):
    done_at = serializers.DateTimeField()


class ImageRefSerializer(serializers.Serializer[Any]):
    camera = serializers.IntegerField()
    light = serializers.CharField(help_text="fills a pane")
    full = serializers.CharField(help_text="every pixel")


class SceneFrameSerializer(serializers.Serializer[Any]):
    number = serializers.IntegerField()
    images = ImageRefSerializer(many=True)
    revision = serializers.IntegerField()
    done = serializers.BooleanField()
    nobody = serializers.BooleanField()


class SceneCameraSerializer(serializers.Serializer[Any]):
    index = serializers.IntegerField()
    name = serializers.CharField()
    width = serializers.IntegerField()
    height = serializers.IntegerField()
    matrix = serializers.ListField(child=serializers.ListField(child=serializers.FloatField()))
    rotation = serializers.ListField(child=serializers.ListField(child=serializers.FloatField()))
    tvec = serializers.ListField(child=serializers.FloatField(), help_text="metres")
    distortion = serializers.ListField(child=serializers.FloatField())
    model = serializers.CharField(help_text="pinhole or fisheye: what the numbers of distortion mean")
    grid = serializers.CharField(help_text="address of its rectangles of the usual person, at all positions")


class SceneSerializer(serializers.Serializer[Any]):
    mode = serializers.CharField(help_text="assignment, layer or tutorial")
    dataset = serializers.DictField()
    grid = serializers.DictField()
    cylinder = serializers.DictField()
    foot_rule = serializers.CharField()
    cameras = SceneCameraSerializer(many=True)
    frames = SceneFrameSerializer(many=True)
    layer = serializers.DictField()
    editable = serializers.BooleanField()
    read_only_reason = serializers.CharField()
    assignment = serializers.DictField(allow_null=True)
    next_person = serializers.IntegerField(help_text="no save of the layer has used it")
    neighbours = serializers.DictField(
        required=False, help_text="before, after: frames of accepted work beside the batch, nearest first"
    )
