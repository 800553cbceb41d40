"""A campaign's gold frames, planted faults, and the qualifications it asks for."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.campaigns import campaign_or_404
from gtm_hit.api.common.fields import LARGEST
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import READS, WRITES, ManagersView, answers, invalid, layer_named
from gtm_hit.models import Campaign, PlantedFault, Planting
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.gold import frames, planting, results
from gtm_hit.ops.qualifications import managing

SHARE: dict[str, Any] = {"min_value": 0.0, "max_value": 1.0}
SEED: dict[str, Any] = {"min_value": 0, "max_value": LARGEST, "default": 1}


class ChooseSerializer(serializers.Serializer[Any]):
    layer = serializers.CharField(max_length=120, help_text="name of the layer with the truth")
    share = serializers.FloatField(**SHARE, help_text="of the frames it knows; 0: none any more")
    seed = serializers.IntegerField(**SEED)


class GoldShape(serializers.Serializer[Any]):
    frames = serializers.IntegerField()
    numbers = serializers.ListField(child=serializers.IntegerField(), help_text="frames that are gold")
    judged = serializers.IntegerField(help_text="times somebody annotated one")
    truth = serializers.IntegerField(help_text="people in those")
    found = serializers.IntegerField()
    extra = serializers.IntegerField()
    placed = serializers.IntegerField(help_text="found within 15 cm")


class SettleSerializer(serializers.Serializer[Any]):
    starting_layer = serializers.CharField(
        max_length=120, allow_null=True, default=None, help_text="null: accepted work in shared frames"
    )
    share = serializers.FloatField(**SHARE, help_text="of the batches that get faults")
    faults = serializers.IntegerField(min_value=1, max_value=planting.MOST_FAULTS, default=2)
    kinds = serializers.ListField(
        child=serializers.ChoiceField(choices=PlantedFault.Kind.values),
        default=PlantedFault.Kind.values,
    )
    seed = serializers.IntegerField(**SEED)


class KindShape(serializers.Serializer[Any]):
    kind = serializers.CharField()
    planted = serializers.IntegerField()
    judged = serializers.IntegerField()
    repaired = serializers.IntegerField()


class FaultsShape(serializers.Serializer[Any]):
    settings = SettleSerializer(allow_null=True, help_text="null: batches start empty")
    results = KindShape(many=True)


class RequireSerializer(serializers.Serializer[Any]):
    names = serializers.ListField(child=serializers.CharField(max_length=120), max_length=50)


class Gold(ManagersView):
    @extend_schema(operation_id="gold", summary="Gold frames", responses=answers(200, GoldShape, READS))
    def get(self, request: Request, slug: str, name: str) -> Response:
        return self.answer(campaign_or_404(slug, name))

    @extend_schema(
        operation_id="choose_gold",
        summary="Choose the share of frames that are gold",
        description="The same again chooses the same. Workers cannot tell which frames they are.",
        request=ChooseSerializer,
        responses=answers(200, GoldShape, WRITES),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(ChooseSerializer(data=request.data))
        truth = layer_named(request, campaign.dataset, wanted["layer"], "layer")
        try:
            frames.choose(campaign, truth, wanted["share"], wanted["seed"])
        except OperationError as error:
            raise invalid("", error) from error
        return self.answer(campaign)

    def answer(self, campaign: Campaign) -> Response:
        numbers = list(frames.gold_frames(campaign).values_list("frame__number", flat=True))
        counted = asdict(results.gold_result(campaign))
        return Response({**counted, "numbers": numbers} | {"frames": len(numbers)})


class PlantedFaults(ManagersView):
    @extend_schema(
        operation_id="planted_faults",
        summary="Which faults are planted, and what became of them",
        responses=answers(200, FaultsShape, READS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        return self.answer(campaign_or_404(slug, name))

    @extend_schema(
        operation_id="settle_faults",
        summary="Settle what batches start with, and which faults are planted there",
        description="For batches taken from now on.",
        request=SettleSerializer,
        responses=answers(200, FaultsShape, WRITES),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(SettleSerializer(data=request.data))
        given = wanted.pop("starting_layer")
        layer = layer_named(request, campaign.dataset, given, "starting_layer") if given else None
        try:
            planting.settle(campaign, layer, **wanted)
        except OperationError as error:
            raise invalid("", error) from error
        return self.answer(campaign)

    @extend_schema(
        operation_id="stop_faults",
        summary="Let batches start empty again",
        responses=answers(200, FaultsShape, READS),
    )
    def delete(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        planting.stop(campaign)
        return self.answer(campaign)

    def answer(self, campaign: Campaign) -> Response:
        now = Planting.objects.filter(campaign=campaign).select_related("starting_layer").first()
        settled = None
        if now is not None:
            layer = now.starting_layer.name if now.starting_layer else None
            settled = {"starting_layer": layer, "share": now.share, "faults": now.faults}
            settled |= {"kinds": now.kinds, "seed": now.seed}
        kinds = KindShape(results.fault_results(campaign), many=True).data
        return Response({"settings": settled, "results": kinds})


class RequiredQualifications(ManagersView):
    @extend_schema(
        operation_id="required_qualifications",
        summary="Qualifications a campaign asks for",
        responses=answers(200, RequireSerializer, READS),
    )
    def get(self, request: Request, slug: str, name: str) -> Response:
        return self.answer(campaign_or_404(slug, name))

    @extend_schema(
        operation_id="require_qualifications",
        summary="Ask for exactly these qualifications from now on",
        request=RequireSerializer,
        responses=answers(200, RequireSerializer, WRITES),
    )
    def post(self, request: Request, slug: str, name: str) -> Response:
        campaign = campaign_or_404(slug, name)
        wanted = valid(RequireSerializer(data=request.data))
        try:
            managing.require(campaign, wanted["names"])
        except OperationError as error:
            raise invalid("names", error) from error
        return self.answer(campaign)

    def answer(self, campaign: Campaign) -> Response:
        asked = campaign.required_qualifications.order_by("qualification__name")
        return Response({"names": list(asked.values_list("qualification__name", flat=True))})
