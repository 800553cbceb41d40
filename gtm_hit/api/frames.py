"""Scenes, frames and their history, for a worker's assignment and for staff on any layer."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from drf_spectacular.utils import OpenApiResponse, extend_schema
from rest_framework.request import Request
from rest_framework.response import Response
from rest_framework.serializers import Serializer
from rest_framework.views import APIView

from gtm_hit.api import scene
from gtm_hit.api.parsing import BoundedJSONParser
from gtm_hit.api.places import AssignmentPlace, LayerPlace, Place
from gtm_hit.api.serializers import (
    ErrorSerializer,
    FrameRangeSerializer,
    FrameStateSerializer,
    FrameStatesSerializer,
    HistorySerializer,
    RevisionQuerySerializer,
    SaveSerializer,
    SceneSerializer,
)
from gtm_hit.models import LayerFrame
from gtm_hit.ops import assignments
from gtm_hit.ops.annotations import history, next_person, read_frame, read_frames, save_frame, state_at


def valid(serializer: Serializer[Any]) -> dict[str, Any]:
    serializer.is_valid(raise_exception=True)
    return serializer.validated_data


def refusal(text: str) -> OpenApiResponse:
    return OpenApiResponse(ErrorSerializer, text)


REFUSALS = {401: refusal("not_signed_in"), 404: refusal("not_found")}


class PlacedView(APIView):
    parser_classes = [BoundedJSONParser]

    def place(self, **kwargs: Any) -> Place:
        raise NotImplementedError


class SceneView(PlacedView):
    @extend_schema(summary="Cameras, grid and frames", responses={200: SceneSerializer, **REFUSALS})
    def get(self, request: Request, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        heads = LayerFrame.objects.filter(layer=place.layer, frame__in=place.frames.order_by())
        parts = {head.frame_id: scene.head_part(head) for head in heads}
        return Response(
            {
                "mode": place.mode,
                **scene.dataset_part(place.dataset),
                "frames": scene.frames_part(place.frames, parts),
                "layer": {
                    "id": place.layer.pk,
                    "name": place.layer.name,
                    "first": place.part.first if place.part else None,
                },
                "editable": not place.read_only_reason,
                "read_only_reason": assignments.explained(place.read_only_reason),
                "assignment": scene.assignment_part(place.assignment),
                "next_person": next_person(place.layer),
                "neighbours": scene.neighbours_part(place.assignment),
            }
        )


class FramesView(PlacedView):
    def get(self, request: Request, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        frames = place.frames
        if place.mode == "layer":
            wanted = valid(FrameRangeSerializer(data=request.query_params))
            frames = frames.filter(number__gte=wanted["from"])[: wanted["count"]]
        states = read_frames(place.layer, frames)
        return Response({"frames": [state.as_dict() for state in states]})


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


class AssignmentScene(AssignmentPlace, SceneView):
    pass


class AssignmentFrames(AssignmentPlace, FramesView):
    @extend_schema(
        operation_id="assignment_frames_list",
        summary="All frames of the batch",
        responses={200: FrameStatesSerializer, **REFUSALS},
    )
    def get(self, request: Request, **kwargs: Any) -> Response:
        return super().get(request, **kwargs)


class AssignmentFrame(AssignmentPlace, FrameView):
    pass


class AssignmentHistory(AssignmentPlace, HistoryView):
    pass


class LayerScene(LayerPlace, SceneView):
    """Of a layer of more than 500 frames the part with the first frame that is not done."""

    in_parts = True


class LayerFrames(LayerPlace, FramesView):
    @extend_schema(
        operation_id="layers_frames_list",
        summary="Some frames of the layer",
        parameters=[FrameRangeSerializer],
        responses={200: FrameStatesSerializer, **REFUSALS},
    )
    def get(self, request: Request, **kwargs: Any) -> Response:
        return super().get(request, **kwargs)


class LayerFrameView(LayerPlace, FrameView):
    pass


class LayerHistory(LayerPlace, HistoryView):
    pass
