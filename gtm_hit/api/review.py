"""The review desk for programs: what waits, what differs, and what is decided about it."""

from __future__ import annotations

from typing import Any

from django.http import Http404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiResponse, extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from gtm_hit.api.common.comments import comment_or_404, listed
from gtm_hit.api.common.fields import LARGEST, StrictBooleanField
from gtm_hit.api.common.refusals import refusal, valid
from gtm_hit.api.common.staff import (
    ASKS,
    READS,
    WRITES,
    Pages,
    ReviewersView,
    answers,
    asked,
    caller,
    dataset_or_404,
    invalid,
)
from gtm_hit.models import Assignment, Campaign, Category
from gtm_hit.ops.quality.layer_rows import QualityError
from gtm_hit.ops.review import comments, facts, mending, queue
from gtm_hit.ops.review.differences import differences
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.references import chosen
from gtm_hit.ops.review.transitions import transition

DECIDES = {**WRITES, 409: refusal("wrong_state: somebody else was faster, or it is too late")}
BY_REVIEWERS = [
    *(Action.ACCEPT, Action.ACCEPT_MENDED, Action.RETURN, Action.TAKE_BACK),
    *(Action.REJECT, Action.UPHOLD, Action.OVERTURN),
]


def assignment_or_404(slug: str, pk: int) -> Assignment:
    found = Assignment.objects.filter(batch__dataset__slug=slug, batch__qualification=None, pk=pk)
    rows = queue.described(found)
    one = rows.select_related("layer__dataset").first()
    if one is None:
        raise Http404
    return one


class ReviewsQuery(serializers.Serializer[Any]):
    campaign = serializers.CharField(max_length=120, required=False, help_text="its name; without: all work")
    list = serializers.ChoiceField(choices=["waiting", "returned", "decided", "appeals"], default="waiting")


class ReviewDecisionSerializer(serializers.Serializer[Any]):
    action = serializers.ChoiceField(choices=[action.value for action in BY_REVIEWERS])
    category = serializers.ChoiceField(choices=Category.choices, required=False, default="")
    reason = serializers.CharField(
        required=False,
        default="",
        allow_blank=True,
        help_text="the worker reads it; needed by all but accept",
    )


class RemarkSerializer(serializers.Serializer[Any]):
    text = serializers.CharField()
    frame = serializers.IntegerField(min_value=0, max_value=LARGEST, required=False, allow_null=True)
    person = serializers.IntegerField(min_value=0, max_value=LARGEST, required=False, allow_null=True)
    position = serializers.IntegerField(min_value=0, max_value=LARGEST, required=False, allow_null=True)
    answers = serializers.IntegerField(
        min_value=1, max_value=LARGEST, required=False, allow_null=True, help_text="a comment's id"
    )


class ResolvedSerializer(serializers.Serializer[Any]):
    resolved = StrictBooleanField()


class DifferencesQuery(serializers.Serializer[Any]):
    reference = serializers.CharField(
        max_length=120, required=False, allow_blank=True, help_text="a layer; empty: none; left out: the best"
    )


ANY = OpenApiResponse(OpenApiTypes.OBJECT)


class Reviews(ReviewersView):
    @extend_schema(
        operation_id="reviews",
        summary="What waits for a review, is returned, was decided, or is appealed against",
        description="What waits comes most suspicious first.",
        parameters=[ReviewsQuery],
        responses=answers(200, ANY, ASKS),
    )
    def get(self, request: Request, slug: str) -> Response:
        dataset = dataset_or_404(slug)
        wanted = asked(request, ReviewsQuery)
        scope = queue.Scope(dataset, campaign_named(dataset, wanted.get("campaign")))
        rows, told = facts.LISTS[wanted["list"]]
        pages = Pages()
        page: list[Any] | None = pages.paginate_queryset(rows(scope), request, view=self)
        return pages.get_paginated_response([told(row) for row in page or []])


def campaign_named(dataset: Any, name: str | None) -> Campaign | None:
    if name is None:
        return None
    found = Campaign.objects.filter(dataset=dataset, name=name).first()
    if found is None:
        raise invalid("campaign", f"There is no campaign {name}.")
    return found


class OneReview(ReviewersView):
    @extend_schema(
        operation_id="review",
        summary="An assignment with its comments, its steps and its appeal",
        responses=answers(200, ANY, READS),
    )
    def get(self, request: Request, slug: str, pk: int) -> Response:
        return Response(facts.whole(assignment_or_404(slug, pk)))


class ReviewDifferences(ReviewersView):
    @extend_schema(
        operation_id="review_differences",
        summary="An assignment beside a reference: frames in time, differences worst first",
        parameters=[DifferencesQuery],
        responses=answers(200, ANY, ASKS),
    )
    def get(self, request: Request, slug: str, pk: int) -> Response:
        assignment = assignment_or_404(slug, pk)
        name = asked(request, DifferencesQuery).get("reference")
        found, reference = chosen(assignment, name)
        if name and reference is None:
            raise invalid("reference", f"There is no layer {name} with frames of this batch.")
        try:
            differing = differences(assignment, reference.layer if reference else None)
        except QualityError as error:
            raise invalid("reference", error) from error
        return Response(
            {
                "reference": reference.layer.name if reference else None,
                "references": [{"name": one.layer.name, "about": one.about} for one in found],
                **differing.as_numbers(),
            }
        )


class Decision(ReviewersView):
    @extend_schema(
        operation_id="decide_review",
        summary="Accept, return, reject, or decide an appeal",
        description="Nobody decides about their own work, and an appeal is decided by somebody else.",
        request=ReviewDecisionSerializer,
        responses=answers(200, ANY, DECIDES),
    )
    def post(self, request: Request, slug: str, pk: int) -> Response:
        assignment = assignment_or_404(slug, pk)
        wanted = valid(ReviewDecisionSerializer(data=request.data))
        action = Action(wanted.pop("action"))
        transition(assignment, action, caller(request), **wanted)
        scope = queue.Scope(assignment.batch.dataset, assignment.batch.campaign)
        following = queue.next_for(scope, caller(request), assignment)
        return Response(
            {
                **facts.whole(assignment_or_404(slug, pk)),
                "next": following.pk if following else None,
                "waiting": queue.counts(scope).waiting,
            }
        )


class ReviewComments(ReviewersView):
    @extend_schema(
        operation_id="comment_review",
        summary="Comment on an assignment, pinned to a frame and a person, or answer a comment",
        request=RemarkSerializer,
        responses=answers(201, ANY, DECIDES),
    )
    def post(self, request: Request, slug: str, pk: int) -> Response:
        assignment = assignment_or_404(slug, pk)
        wanted = valid(RemarkSerializer(data=request.data))
        text, answered = wanted.pop("text"), wanted.pop("answers", None)
        if answered is not None:
            comments.answer(comment_or_404(assignment, answered), caller(request), text)
        else:
            comments.remark(assignment, caller(request), text, comments.Pin(**wanted))
        return listed(assignment, 201)


class ReviewComment(ReviewersView):
    @extend_schema(
        operation_id="resolve_review_comment",
        summary="Mark a comment as done, or as open again",
        request=ResolvedSerializer,
        responses=answers(200, ANY, DECIDES),
    )
    def post(self, request: Request, slug: str, pk: int, comment: int) -> Response:
        assignment = assignment_or_404(slug, pk)
        resolved = valid(ResolvedSerializer(data=request.data))["resolved"]
        comments.resolve(comment_or_404(assignment, comment), caller(request), resolved)
        return listed(assignment)


class ReviewMend(ReviewersView):
    @extend_schema(
        operation_id="mend_review",
        summary="A copy of the worker's layer under one's own name, to be put right",
        description="The same again: the same copy. `accept_mended` then accepts it in the layer's place.",
        request=None,
        responses=answers(200, ANY, DECIDES),
    )
    def post(self, request: Request, slug: str, pk: int) -> Response:
        made = mending.mend(assignment_or_404(slug, pk), caller(request))
        return Response({"layer": made.layer.name})
