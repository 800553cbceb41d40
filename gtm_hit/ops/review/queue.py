"""What waits for a reviewer, what was decided, and who appeals; each list in a constant number of queries."""

from __future__ import annotations

from dataclasses import dataclass

from django.contrib.auth.models import User
from django.db.models import Count, F, OuterRef, Q, QuerySet

from gtm_hit.models import Annotation, Appeal, Assignment, Batch, Campaign, Comment, Dataset, Transition
from gtm_hit.ops.counting import correlated_count
from gtm_hit.ops.review.actors import own_work
from gtm_hit.ops.review.machine import DECISIONS

LOOKED_THROUGH = 100  # to find the next that is not the reviewer's own


@dataclass(frozen=True)
class Scope:
    """A campaign's work, or with no campaign that of the whole dataset; never tries for a qualification."""

    dataset: Dataset
    campaign: Campaign | None = None

    def within(self, prefix: str = "") -> Q:
        if self.campaign is not None:
            return Q(**{f"{prefix}batch__campaign": self.campaign})
        return Q(**{f"{prefix}batch__dataset": self.dataset, f"{prefix}batch__qualification": None})


@dataclass(frozen=True)
class Counts:
    waiting: int
    returned: int  # with their workers
    appeals: int  # open


def counts(scope: Scope) -> Counts:
    states = Assignment.objects.filter(scope.within()).aggregate(
        waiting=Count("pk", Q(state=Assignment.State.SUBMITTED)),
        returned=Count("pk", Q(state=Assignment.State.RETURNED)),
    )
    return Counts(**states, appeals=open_appeals(scope).count())


def waiting(scope: Scope) -> QuerySet[Assignment]:
    """With `frame_count`, `people` and `open_comments`; the most suspicious first, then who waits longest."""
    found = Assignment.objects.filter(scope.within(), state=Assignment.State.SUBMITTED)
    return described(found).order_by(
        F("review_choice__suspicion").desc(nulls_last=True), "submitted_at", "pk"
    )


def described(found: QuerySet[Assignment]) -> QuerySet[Assignment]:
    frames = Batch.frames.through.objects.filter(batch=OuterRef("batch"))
    people = Annotation.objects.filter(layer=OuterRef("layer"))
    remarks = Comment.objects.filter(assignment=OuterRef("pk"), answers=None, resolved_at=None)
    related = ("batch__dataset", "batch__campaign", "worker", "layer", "review_choice")
    return found.select_related(*related).annotate(
        frame_count=correlated_count(frames, "batch", "pk"),
        people=correlated_count(people, "layer", "person", distinct=True),
        open_comments=correlated_count(remarks, "assignment", "pk"),
    )


def returned(scope: Scope) -> QuerySet[Assignment]:
    found = Assignment.objects.filter(scope.within(), state=Assignment.State.RETURNED)
    return described(found).order_by("submitted_at", "pk")


def decided(scope: Scope) -> QuerySet[Transition]:
    """The decisions, the newest first."""
    found = Transition.objects.filter(scope.within("assignment__"), action__in=sorted(DECISIONS))
    return found.select_related(
        "user", "assignment__batch", "assignment__worker", "assignment__review_choice"
    ).order_by("-at", "-pk")


def open_appeals(scope: Scope) -> QuerySet[Appeal]:
    found = Appeal.objects.filter(scope.within("assignment__"), outcome=Appeal.Outcome.OPEN)
    return found.select_related("assignment__batch", "assignment__worker").order_by("created_at")


def next_for(scope: Scope, user: User, after: Assignment | None = None) -> Assignment | None:
    """The first that waits and is not the reviewer's own work, nor the one he just comes from."""
    found = waiting(scope).exclude(pk=after.pk) if after else waiting(scope)
    return next((one for one in found[:LOOKED_THROUGH] if not own_work(user, one.worker)), None)


def rejection(assignment: Assignment) -> Transition | None:
    """The last one; its category and reason are what the worker reads."""
    return last_step(assignment, "reject")


def last_step(assignment: Assignment, *actions: str) -> Transition | None:
    found = Transition.objects.filter(assignment=assignment, action__in=actions)
    return found.select_related("user").order_by("-number").first()
