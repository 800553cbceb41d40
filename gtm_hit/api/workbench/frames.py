"""Scenes, frames and their history, for a worker's assignment and for staff on any layer."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from django.db.models import QuerySet
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.refusals import REFUSALS, refusal, valid
from gtm_hit.api.workbench import scene
from gtm_hit.api.workbench.places import Place, PlacedView
from gtm_hit.api.workbench.scene import SceneSerializer
from gtm_hit.models import Annotation, Frame, LayerFrame
from gtm_hit.ops.frames.saving import (
    history,
    next_person,
    read_frame,
    read_frames,
    save_frame,
    state_at,
)
from gtm_hit.ops.proposals import runs
from gtm_hit.ops.work import assignments


class PersonSerializer(serializers.Serializer[Any]):
    person = serializers.IntegerField(min_value=0)
    position = serializers.IntegerField(min_value=0, help_text="row * columns + column")
    height = serializers.FloatField(allow_null=True, help_text="metres; null: the dataset's cylinder")
    radius = serializers.FloatField(allow_null=True, help_text="metres; null: the dataset's cylinder")


class AnnotationSerializer(PersonSerializer):
    state = serializers.ChoiceField(choices=Annotation.State.choices)
    origin = serializers.ChoiceField(choices=Annotation.Origin.choices)


@extend_schema_field(AnnotationSerializer(many=True))
class AnnotationsField(serializers.JSONField):
    """Passed on as sent, so that all problems of a frame are reported together with their places."""


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
    calibration = serializers.IntegerField(
        allow_null=True, help_text="number of the calibration in place then; null: not known"
    )


class HistorySerializer(serializers.Serializer[Any]):
    revisions = RevisionSerializer(many=True)


class FrameRangeSerializer(serializers.Serializer[Any]):
    """Query of a layer's frames."""

    count = serializers.IntegerField(min_value=1, max_value=50, default=50)

    def get_fields(self) -> dict[str, Any]:
        # `from` cannot be an attribute's name.
        start = serializers.IntegerField(min_value=0, max_value=LARGEST, default=0, help_text="frame number")
        return {"from": start, **super().get_fields()}


class RevisionQuerySerializer(serializers.Serializer[Any]):
    revision = serializers.IntegerField(min_value=0, max_value=LARGEST, required=False)


class SceneView(PlacedView):
    @extend_schema(
        summary="Cameras, grid and frames",
        description="Of a layer of more than 500 frames the part with the first frame that is not done.",
        responses={200: SceneSerializer, **REFUSALS},
    )
    def get(self, request: Request, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        heads = LayerFrame.objects.filter(layer=place.layer, frame__in=place.frames.order_by())
        head_of = {head.frame_id: head for head in heads}
        return Response(
            {
                "mode": place.mode,
                **scene.dataset_part(place.dataset),
                "frames": scene.frames_part(place.frames, head_of),
                "layer": {
                    "id": place.layer.pk,
                    "key": place.layer.key,
                    "name": place.layer.name,
                    "created_at": place.layer.created_at,
                    "first": place.part.first if place.part else None,
                },
                "editable": not place.read_only_reason,
                "read_only_reason": assignments.explained(place.read_only_reason),
                "assignment": scene.assignment_part(place.assignment),
                "next_person": next_person(place.layer),
                "neighbours": scene.neighbours_part(place.assignment),
                "proposed": runs.in_use(place.dataset) is not None,
            }
        )


class AssignmentFrames(PlacedView):
    @extend_schema(
        operation_id="assignment_frames_list",
        summary="All frames of the batch",
        responses={200: FrameStatesSerializer, **REFUSALS},
    )
    def get(self, request: Request, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        return states(place, place.frames)


class LayerFrames(PlacedView):
    @extend_schema(
        operation_id="layers_frames_list",
        summary="Some frames of the layer",
        parameters=[FrameRangeSerializer],
        responses={200: FrameStatesSerializer, **REFUSALS},
    )
    def get(self, request: Request, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        wanted = valid(FrameRangeSerializer(data=request.query_params))
        return states(place, place.frames.filter(number__gte=wanted["from"])[: wanted["count"]])


def states(place: Place, frames: QuerySet[Frame]) -> Response:
    return Response({"frames": [state.as_dict() for state in read_frames(place.layer, frames)]})


class FrameView(PlacedView):
    @extend_schema(
        summary="A frame as it is, or as it was after a save",
        parameters=[RevisionQuerySerializer],
        responses={200: FrameStateSerializer, **REFUSALS},
    )
    def get(self, request: Request, number: int, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        frame = place.frame(number)
        revision = valid(RevisionQuerySerializer(data=request.query_params)).get("revision")
        if revision is None:
            return Response(read_frame(place.layer, frame).as_dict())
        return Response(state_at(place.layer, frame, revision).as_dict())

    @extend_schema(
        summary="Replace a frame",
        description="The same `save_id` again answers as before and writes nothing.",
        request=SaveSerializer,
        responses={
            200: FrameStateSerializer,
            400: refusal("invalid; details: a list of place and reason"),
            403: refusal("read_only; details.reason: submitted, expired, not_author or protected"),
            409: refusal("save_id_used"),
            412: refusal("stale; details.current: the frame as it is now"),
            **REFUSALS,
        },
    )
    def put(self, request: Request, number: int, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        place.require_unprotected()
        frame = place.frame(number)
        wanted = valid(SaveSerializer(data=request.data))
        state = save_frame(place.layer, frame, place.author, **wanted)
        return Response(state.as_dict())


class HistoryView(PlacedView):
    @extend_schema(summary="Every save of a frame", responses={200: HistorySerializer, **REFUSALS})
    def get(self, request: Request, number: int, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        revisions = history(place.layer, place.frame(number))
        return Response({"revisions": [asdict(revision) for revision in revisions]})
