"""Proposals of the frames that a caller works on, and what they refuse of them."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.refusals import REFUSALS, refusal, valid
from gtm_hit.api.common.staff import invalid
from gtm_hit.api.workbench.places import PlacedView
from gtm_hit.ops.frames.neighbours import Neighbours, neighbours
from gtm_hit.ops.proposals import reading, refusals, snapping
from gtm_hit.ops.proposals.errors import ProposalError

MOST_OTHERS = 1000


class EvidenceSerializer(serializers.Serializer[Any]):
    camera = serializers.CharField()
    box = serializers.ListField(
        child=serializers.FloatField(), allow_null=True, help_text="x1, y1, x2, y2, pixels"
    )
    seen = serializers.FloatField(allow_null=True, help_text="share of the rectangle that is not background")
    hidden = serializers.BooleanField(help_text="somebody nearer covers most of it")


class ProposedSerializer(serializers.Serializer[Any]):
    id = serializers.IntegerField()
    position = serializers.IntegerField()
    height = serializers.FloatField(allow_null=True)
    radius = serializers.FloatField(allow_null=True)
    score = serializers.FloatField(help_text="0 to 1")
    doubt = serializers.FloatField(help_text="0 to 1: what should be looked at first")
    track = serializers.IntegerField(help_text="who is who among these proposals")
    person = serializers.IntegerField(allow_null=True, help_text="the number the track has in the layer")
    seated = serializers.BooleanField()
    filled = serializers.BooleanField(help_text="seen before and after, not in this frame")
    evidence = EvidenceSerializer(many=True)


class ProposedFrameSerializer(serializers.Serializer[Any]):
    number = serializers.IntegerField()
    people = ProposedSerializer(many=True)
    refused = serializers.ListField(child=serializers.IntegerField(), help_text="positions")


class ProposalsSerializer(serializers.Serializer[Any]):
    run = serializers.IntegerField(allow_null=True, help_text="null: nothing is proposed")
    threshold = serializers.FloatField(help_text="score from which on somebody is taken for real")
    frames = ProposedFrameSerializer(many=True)


class RefusalSerializer(serializers.Serializer[Any]):
    frame = serializers.IntegerField(min_value=0, max_value=LARGEST)
    position = serializers.IntegerField(min_value=0, max_value=LARGEST)
    refused = StrictBooleanField(default=True, help_text="false: takes it back")


class SnappedMarkSerializer(serializers.Serializer[Any]):
    position = serializers.IntegerField(min_value=0, max_value=LARGEST)
    height = serializers.FloatField(
        min_value=0.3, max_value=3, allow_null=True, default=None, help_text="metres; null: as tall as usual"
    )


class SnapSerializer(SnappedMarkSerializer):
    frame = serializers.IntegerField(min_value=0, max_value=LARGEST)
    others = serializers.ListField(
        child=SnappedMarkSerializer(),
        max_length=MOST_OTHERS,
        help_text="everybody else who is marked in the frame",
    )


class SnappedSerializer(serializers.Serializer[Any]):
    position = serializers.IntegerField()
    metres = serializers.FloatField(help_text="from where it was marked")
    gain = serializers.FloatField(help_text="of what the views say; a box that fits is worth up to 1")
    refused = serializers.ChoiceField(
        choices=["", "unseen", "nothing", "small", "near"],
        help_text="why the mark stays: no program has looked, no view shows anybody, it is about as good "
        "where it is, somebody else stands there",
    )
    background = serializers.BooleanField(
        help_text="by the foreground that the run has kept, too; else by the boxes alone"
    )


class ProposalsView(PlacedView):
    @extend_schema(
        summary="People whom programs propose, never annotations by themselves",
        responses={200: ProposalsSerializer, **REFUSALS},
    )
    def get(self, request: Request, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        beside = neighbours(place.assignment.batch) if place.assignment else Neighbours()
        found = reading.for_layer(place.layer, list(place.frames), beside)
        return Response(
            {
                "run": found.run.pk if found.run else None,
                "threshold": reading.CERTAIN,
                "frames": [asdict(frame) for frame in found.frames],
            }
        )


class RefusalsView(PlacedView):
    @extend_schema(
        summary="Say that nobody is where somebody is proposed, or take that back",
        request=RefusalSerializer,
        responses={
            200: RefusalSerializer,
            400: refusal("invalid; details: a list of place and reason"),
            403: refusal("read_only; details.reason: submitted, expired, not_author or protected"),
            **REFUSALS,
        },
    )
    def post(self, request: Request, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        place.require_unprotected()
        wanted = valid(RefusalSerializer(data=request.data))
        frame = place.frame(wanted["frame"])
        try:
            refusals.refuse(place.layer, frame, wanted["position"], place.author, wanted["refused"])
        except ProposalError as error:
            raise invalid("position", error) from error
        return Response(wanted)


class SnapView(PlacedView):
    @extend_schema(
        summary="Where somebody marked roughly seems to stand; changes nothing",
        description="By the boxes and the foreground that the run shown has kept; at most half a metre away.",
        request=SnapSerializer,
        responses={
            200: SnappedSerializer,
            400: refusal("invalid; details: a list of place and reason"),
            **REFUSALS,
        },
    )
    def post(self, request: Request, **kwargs: Any) -> Response:
        place = self.place(**kwargs)
        wanted = valid(SnapSerializer(data=request.data))
        frame = place.frame(wanted["frame"])
        mark = snapping.Mark(wanted["position"], wanted["height"])
        others = [snapping.Mark(**each) for each in wanted["others"]]
        try:
            return Response(asdict(snapping.snap_mark(place.layer, frame, mark, others)))
        except ProposalError as error:
            raise invalid("position", error) from error
