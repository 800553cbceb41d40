"""The tutorial: prepared frames, steps judged on the server."""

from __future__ import annotations

from typing import Any

from django.http import Http404
from django.utils.translation import gettext as _
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.parsing import BoundedJSONParser
from gtm_hit.api.common.refusals import REFUSALS, refusal, valid
from gtm_hit.api.workbench import scene
from gtm_hit.api.workbench.frames import (
    AnnotationsField,
    FrameStateSerializer,
    FrameStatesSerializer,
)
from gtm_hit.api.workbench.places import TutorialPlace
from gtm_hit.api.workbench.scene import SceneSerializer
from gtm_hit.models import LayerFrame
from gtm_hit.ops.tutorial import lesson
from gtm_hit.ops.tutorial.judging import Mistake
from gtm_hit.ops.tutorial.lesson import Step


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
    mistake = serializers.ChoiceField(list(Mistake), allow_null=True)
    person = serializers.IntegerField(allow_null=True, help_text="whom it is about, if they have a box")
    feet = serializers.IntegerField(allow_null=True, help_text="the position at which they should stand")


class TutorialDoneSerializer(serializers.Serializer[Any]):
    done_at = serializers.DateTimeField()


class TutorialScene(TutorialPlace):
    @extend_schema(summary="The tutorial's scene", responses={200: SceneSerializer, **REFUSALS})
    def get(self, request: Request) -> Response:
        loaded = lesson.load()
        heads = {frame.pk: LayerFrame(revision=1) for frame in loaded.frames}
        return Response(
            {
                "mode": "tutorial",
                **scene.dataset_part(loaded.dataset),
                "frames": scene.frames_part(loaded.frames, heads),
                "layer": {"id": 0, "name": "tutorial"},
                "editable": True,
                "read_only_reason": "",
                "assignment": None,
                "next_person": loaded.exercise.next_person,
            }
        )


class TutorialFrames(TutorialPlace):
    @extend_schema(
        operation_id="tutorial_frames_list",
        summary="The tutorial's prepared frames",
        responses={200: FrameStatesSerializer, **REFUSALS},
    )
    def get(self, request: Request) -> Response:
        return Response({"frames": [state.as_dict() for state in lesson.load().states()]})


class TutorialFrame(TutorialPlace):
    @extend_schema(
        summary="One of the tutorial's prepared frames", responses={200: FrameStateSerializer, **REFUSALS}
    )
    def get(self, request: Request, number: int) -> Response:
        for state in lesson.load().states():
            if state.number == number:
                return Response(state.as_dict())
        raise Http404


class TutorialCheck(TutorialPlace):
    parser_classes = [BoundedJSONParser]

    @extend_schema(
        summary="Judge a step",
        request=CheckSerializer,
        responses={200: VerdictSerializer, 400: refusal("invalid"), **REFUSALS},
    )
    def post(self, request: Request) -> Response:
        wanted = valid(CheckSerializer(data=request.data))
        verdict = lesson.check(self.worker, wanted["step"], wanted["frame"], wanted["annotations"])
        return Response(VerdictSerializer(verdict).data)


class TutorialDone(TutorialPlace):
    parser_classes = [BoundedJSONParser]

    @extend_schema(
        summary="Finish the tutorial",
        request=None,
        responses={200: TutorialDoneSerializer, 409: refusal("unfinished; details.steps"), **REFUSALS},
    )
    def post(self, request: Request) -> Response:
        return Response({"done_at": lesson.finish(self.worker).tutorial_done_at})
