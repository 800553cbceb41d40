"""Runs that propose people, the layers made of them, and who is missing in a layer."""

from __future__ import annotations

from typing import Any

from django.http import Http404
from drf_spectacular.utils import OpenApiExample, extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.refusals import refusal, valid
from gtm_hit.api.common.staff import (
    ASKS,
    READS,
    WRITES,
    ReviewersView,
    StaffView,
    answers,
    asked,
    caller,
    dataset_or_404,
    invalid,
    layer_or_404,
)
from gtm_hit.api.jobs import JobShape, started
from gtm_hit.models import ApiToken, Dataset, ProposalRun
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.proposals import detectors, job, layers, runs
from gtm_hit.ops.proposals import missing as missing_people
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.runs import RunSummary


class RunSerializer(serializers.Serializer[Any]):
    id = serializers.IntegerField()
    method = serializers.ChoiceField(choices=ProposalRun.Method.choices)
    model = serializers.CharField(help_text="the detector's name and version")
    parameters = serializers.DictField()
    in_use = serializers.BooleanField(help_text="its people are shown to annotators")
    fits = serializers.BooleanField(help_text="false: another calibration is in place by now")
    frames = serializers.IntegerField(help_text="looked at so far")
    people = serializers.IntegerField()
    tracks = serializers.IntegerField()
    seconds_per_frame = serializers.FloatField(allow_null=True)
    alarms = serializers.DictField(
        child=serializers.IntegerField(), help_text="frames in which a camera disagreed with all others"
    )
    created_at = serializers.DateTimeField()


class RunsSerializer(serializers.Serializer[Any]):
    methods = serializers.ListField(child=serializers.CharField())
    detectors = serializers.ListField(child=serializers.CharField())
    leaves_the_server = serializers.BooleanField(help_text="whether there is an address pictures may go to")
    results = RunSerializer(many=True)


class OrderSerializer(serializers.Serializer[Any]):
    method = serializers.ChoiceField(choices=job.METHODS, default="cover")
    detector = serializers.CharField(default=detectors.BUILT_IN, max_length=300)
    use = StrictBooleanField(default=True, help_text="annotators see its people from then on")


class UseSerializer(serializers.Serializer[Any]):
    in_use = StrictBooleanField(help_text="false: annotators see nobody's proposals")


class MakeLayerSerializer(serializers.Serializer[Any]):
    layer = serializers.CharField(max_length=120, help_text="a name no layer of the dataset has")
    threshold = serializers.FloatField(min_value=0, max_value=1, default=layers.THRESHOLD)


class LayerMadeSerializer(serializers.Serializer[Any]):
    layer = serializers.CharField()


class MissingQuery(serializers.Serializer[Any]):
    start = serializers.IntegerField(min_value=0, max_value=LARGEST, default=0, help_text="frame number")


class PlaceSerializer(serializers.Serializer[Any]):
    frame = serializers.IntegerField(help_text="its number")
    why = serializers.ChoiceField(choices=[why.value for why in missing_people.Why])
    position = serializers.IntegerField()
    x = serializers.FloatField(help_text="metres")
    y = serializers.FloatField(help_text="metres")
    person = serializers.IntegerField(allow_null=True)
    weight = serializers.FloatField(help_text="0 to 1: how likely something is wrong")
    words = serializers.CharField()


class MissingSerializer(serializers.Serializer[Any]):
    run = serializers.IntegerField(allow_null=True, help_text="null: nothing is proposed, only holes tell")
    frames = serializers.IntegerField(help_text="looked through")
    later = serializers.IntegerField(help_text="frames after those")
    results = PlaceSerializer(many=True)


class MissingDecisionSerializer(serializers.Serializer[Any]):
    decision = serializers.ChoiceField(choices=["place", "nobody"])
    frame = serializers.IntegerField(min_value=0, max_value=LARGEST)
    position = serializers.IntegerField(min_value=0, max_value=LARGEST)
    person = serializers.IntegerField(
        min_value=0, max_value=LARGEST, allow_null=True, default=None, help_text="null: somebody new"
    )


class DecidedSerializer(serializers.Serializer[Any]):
    person = serializers.IntegerField(allow_null=True, help_text="the number of whoever was placed")


def run_part(found: RunSummary) -> dict[str, Any]:
    run = found.run
    return {
        "id": run.pk,
        "method": run.method,
        "model": run.model,
        "parameters": run.parameters,
        "in_use": run.in_use,
        "fits": found.fits,
        "frames": found.frames,
        "people": found.people,
        "tracks": found.tracks,
        "seconds_per_frame": found.seconds,
        "alarms": found.alarms,
        "created_at": run.created_at,
    }


def run_or_404(dataset: Dataset, pk: int) -> ProposalRun:
    found = runs.run_of(dataset, pk)
    if found is None:
        raise Http404
    return found


class RunsView(StaffView):
    write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.WORK


class Runs(RunsView):
    @extend_schema(
        operation_id="proposal_runs",
        summary="Runs that propose people, the newest first",
        responses=answers(200, RunsSerializer, READS),
    )
    def get(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        return Response(
            {
                "methods": job.METHODS,
                "detectors": detectors.choices(),
                "leaves_the_server": bool(detectors.addresses()),
                "results": [run_part(found) for found in runs.summaries(dataset)],
            }
        )

    @extend_schema(
        operation_id="propose",
        summary="Look at every frame that is still to be looked at",
        description="A job; the one under way when it is the same.",
        request=OrderSerializer,
        responses=answers(202, JobShape, WRITES),
        examples=[OpenApiExample("without a detector", {"method": "background", "detector": "none"})],
    )
    def post(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = valid(OrderSerializer(data=request.data))
        try:
            return started(job.start(dataset, job.Order(**wanted), caller(request)))
        except ProposalError as error:
            raise invalid("", error) from error


class OneRun(RunsView):
    @extend_schema(
        operation_id="use_proposals",
        summary="Show a run's people to annotators, or nobody's",
        request=UseSerializer,
        responses=answers(200, UseSerializer, WRITES),
    )
    def post(self, request: Request, slug: str, number: int) -> Response:
        run = run_or_404(dataset_or_404(slug), number)
        wanted = valid(UseSerializer(data=request.data))
        if wanted["in_use"]:
            runs.use(run)
        elif run.in_use:
            runs.use_none(run.dataset)
        return Response(wanted)

    @extend_schema(
        operation_id="remove_proposals",
        summary="Remove a run with everybody it proposed; annotations that came of it stay",
        responses=answers(204, None, READS),
    )
    def delete(self, request: Request, slug: str, number: int) -> Response:
        runs.remove(run_or_404(dataset_or_404(slug), number))
        return Response(status=204)


class RunLayer(RunsView):
    @extend_schema(
        operation_id="make_proposal_layer",
        summary="Make a layer of a run, to be compared and exported",
        request=MakeLayerSerializer,
        responses=answers(200, LayerMadeSerializer, WRITES),
    )
    def post(self, request: Request, slug: str, number: int) -> Response:
        run = run_or_404(dataset_or_404(slug), number)
        wanted = valid(MakeLayerSerializer(data=request.data))
        try:
            made = layers.make_layer(run, wanted["layer"], wanted["threshold"])
        except ProposalError as error:
            raise invalid("layer", error) from error
        return Response({"layer": made.name})


class MissingPeople(ReviewersView):
    @extend_schema(
        operation_id="missing_people",
        summary="Who is missing in a layer, the likeliest first",
        parameters=[MissingQuery],
        responses=answers(200, MissingSerializer, ASKS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        found = missing_people.missing(
            layer_or_404(request, slug, name), asked(request, MissingQuery)["start"]
        )
        return Response(
            {
                "run": found.run.pk if found.run else None,
                "frames": found.frames,
                "later": found.later,
                "results": [place.as_dict() for place in found.places],
            }
        )

    @extend_schema(
        operation_id="decide_missing",
        summary="Place the missing person, or say that nobody is there",
        request=MissingDecisionSerializer,
        responses={
            **answers(200, DecidedSerializer, WRITES),
            403: refusal("forbidden, or read_only: a worker's layer is changed by that worker only"),
        },
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        layer = layer_or_404(request, slug, name)
        wanted = valid(MissingDecisionSerializer(data=request.data))
        where = (layer, wanted["frame"], wanted["position"])
        try:
            if wanted["decision"] == "nobody":
                missing_people.dismiss(*where, caller(request))
                return Response({"person": None})
            return Response({"person": missing_people.place(*where, wanted["person"], caller(request))})
        except ProposalError as error:
            raise invalid("", error) from error
