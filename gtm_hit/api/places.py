"""Where a caller works: the layer and frames he reaches through what he owns, never by an id alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

from django.contrib.auth.models import User
from django.db.models import QuerySet
from django.http import Http404
from rest_framework.views import APIView

from gtm_hit.api.authentication import (
    AssignmentAuthentication,
    BearerAuthentication,
    HoldsAssignment,
    HoldsSeat,
    StaffMay,
    StaffSession,
    WorkerAuthentication,
)
from gtm_hit.models import ApiToken, Assignment, Dataset, Frame, Layer, Worker
from gtm_hit.ops import assignments, parts, tokens
from gtm_hit.ops.annotations import Author

PROTECTED = "protected"


@dataclass(frozen=True)
class Place:
    mode: str
    dataset: Dataset
    layer: Layer
    frames: QuerySet[Frame]
    author: Author
    read_only_reason: str
    assignment: Assignment | None = None
    part: parts.Part | None = None  # of a layer that is too long to be opened whole

    def require_unprotected(self) -> None:
        if self.read_only_reason == PROTECTED:
            raise assignments.ReadOnly(PROTECTED)

    def frame(self, number: int) -> Frame:
        frame = self.frames.filter(number=number).first()
        if frame is None:
            raise Http404
        return frame


class AssignmentPlace(APIView):
    authentication_classes = [AssignmentAuthentication]
    permission_classes = [HoldsAssignment]

    @property
    def assignment(self) -> Assignment:
        return cast(Assignment, self.request.auth)

    def place(self, **kwargs: Any) -> Place:
        assignment = self.assignment
        return Place(
            mode="assignment",
            dataset=assignment.batch.dataset,
            layer=assignment.layer,
            frames=Frame.objects.filter(batches=assignment.batch_id).order_by("number"),
            author=assignment.worker,
            read_only_reason=assignments.read_only_reason(assignment),
            assignment=assignment,
        )


class LayerPlace(APIView):
    authentication_classes = [BearerAuthentication, StaffSession]
    permission_classes = [StaffMay]
    write_scope = ApiToken.Scope.WORK
    in_parts = False  # also under the address of the whole layer

    def place(self, **kwargs: Any) -> Place:
        found = Layer.objects.select_related("dataset").filter(pk=kwargs["layer"]).first()
        if found is None:
            raise Http404
        assignment = Assignment.objects.select_related("batch__dataset").filter(layer=found).first()
        scope: dict[str, Any] = (
            {"batches": assignment.batch_id} if assignment else {"dataset": found.dataset_id}
        )
        part = parts.part_of(found, kwargs.get("first")) if self.in_parts or "first" in kwargs else None
        if part:
            scope["number__range"] = (part.first, part.last)
        return Place(
            mode="layer",
            dataset=found.dataset,
            layer=found,
            frames=Frame.objects.filter(**scope).order_by("number"),
            author=cast(User, self.request.user),
            read_only_reason=self._read_only_reason(found),
            assignment=assignment,
            part=part,
        )

    def _read_only_reason(self, layer: Layer) -> str:
        if layer.kind == Layer.Kind.ASSIGNMENT:
            return "not_author"
        # A script that works through layers must not get at what others are measured by.
        if not isinstance(self.request.auth, ApiToken):
            return ""
        kept = layer.hidden or layer.kind == Layer.Kind.IMPORTED or layer.releases.exists()
        return PROTECTED if kept else ""


class TutorialPlace(APIView):
    authentication_classes = [WorkerAuthentication]
    permission_classes = [HoldsSeat]

    @property
    def worker(self) -> Worker:
        return cast(tokens.Seat, self.request.auth).worker
