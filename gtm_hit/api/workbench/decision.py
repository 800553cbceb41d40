"""What a worker reads about their work and answers to it: comments, the decision, an appeal."""

from __future__ import annotations

from typing import Any, cast

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.comments import comment_or_404, listed
from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.refusals import REFUSALS, refusal, valid
from gtm_hit.api.workbench.places import PlacedView
from gtm_hit.models import Assignment
from gtm_hit.ops.review import comments
from gtm_hit.ops.review.decision import told
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition

WRITES: dict[int, Any] = {
    400: refusal("invalid"),
    409: refusal("wrong_state: it is too late for that"),
    **REFUSALS,
}


class CommentsSerializer(serializers.Serializer[Any]):
    comments = serializers.ListField(child=serializers.DictField(), help_text="remarks with their answers")


class AnswerSerializer(serializers.Serializer[Any]):
    text = serializers.CharField()
    answers = serializers.IntegerField(min_value=1, max_value=LARGEST, help_text="the comment's id")


class DoneSerializer(serializers.Serializer[Any]):
    resolved = StrictBooleanField()


class AppealSerializer(serializers.Serializer[Any]):
    text = serializers.CharField(help_text="what was judged wrongly")


class DecisionSerializer(serializers.Serializer[Any]):
    state = serializers.CharField()
    category = serializers.CharField(help_text="in words; empty unless rejected")
    reason = serializers.CharField()
    may_appeal = serializers.BooleanField()
    appeal = serializers.DictField(allow_null=True, help_text="text, outcome, answer")


def mine(request: Request) -> Assignment:
    return cast(Assignment, request.auth)


class AssignmentComments(PlacedView):
    @extend_schema(
        summary="The reviewer's comments on the batch", responses={200: CommentsSerializer, **REFUSALS}
    )
    def get(self, request: Request) -> Response:
        return listed(mine(request))

    @extend_schema(
        operation_id="answer_comment",
        summary="Answer a comment",
        request=AnswerSerializer,
        responses={201: CommentsSerializer, **WRITES},
    )
    def post(self, request: Request) -> Response:
        wanted = valid(AnswerSerializer(data=request.data))
        comments.answer(
            comment_or_404(mine(request), wanted["answers"]), mine(request).worker, wanted["text"]
        )
        return listed(mine(request), 201)


class AssignmentComment(PlacedView):
    @extend_schema(
        operation_id="resolve_comment",
        summary="Mark a comment as done, or as open again",
        request=DoneSerializer,
        responses={200: CommentsSerializer, **WRITES},
    )
    def post(self, request: Request, pk: int) -> Response:
        resolved = valid(DoneSerializer(data=request.data))["resolved"]
        comments.resolve(comment_or_404(mine(request), pk), mine(request).worker, resolved)
        return listed(mine(request))


class AssignmentDecision(PlacedView):
    @extend_schema(
        summary="What was decided about the batch", responses={200: DecisionSerializer, **REFUSALS}
    )
    def get(self, request: Request) -> Response:
        return Response(told(mine(request)).as_dict())


class AssignmentAppeal(PlacedView):
    @extend_schema(
        summary="Object to a rejection, once; somebody else decides",
        request=AppealSerializer,
        responses={201: DecisionSerializer, **WRITES},
    )
    def post(self, request: Request) -> Response:
        text = valid(AppealSerializer(data=request.data))["text"]
        transition(mine(request), Action.APPEAL, mine(request).worker, reason=text)
        return Response(told(mine(request)).as_dict(), status=201)
