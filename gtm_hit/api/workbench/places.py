"""Where a caller works: the layer and frames they reach through what they own, never by an id alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, cast

from django.contrib.auth.models import User
from django.db.models import QuerySet
from django.http import Http404
from rest_framework.authentication import BaseAuthentication
from rest_framework.request import Request
from rest_framework.views import APIView

from gtm_hit.api.common.authentication import (
    AssignmentAuthentication,
    BearerAuthentication,
    HoldsAssignment,
    HoldsSeat,
    StaffMay,
    StaffSession,
    WorkerAuthentication,
)
from gtm_hit.api.common.parsing import BoundedJSONParser
from gtm_hit.models import ApiToken, Assignment, Dataset, Frame, Layer, Worker
from gtm_hit.ops.access.roles import CARES, SEES, layers_of, may
from gtm_hit.ops.frames import parts
from gtm_hit.ops.frames.saving import Author
from gtm_hit.ops.work import assignments, links

PROTECTED = "protected"
KEPT_KINDS = {Layer.Kind.IMPORTED, Layer.Kind.GROUND_TRUTH}


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


def assignment_place(request: Request, **_kwargs: Any) -> Place:
    assignment = cast(Assignment, request.auth)
    return Place(
        mode="assignment",
        dataset=assignment.batch.dataset,
        layer=assignment.layer,
        frames=Frame.objects.filter(batches=assignment.batch_id).order_by("number"),
        author=assignment.worker,
        read_only_reason=assignments.read_only_reason(assignment),
        assignment=assignment,
    )


def layer_place(request: Request, **kwargs: Any) -> Place:
    """The layer with the number in the address, or the part of it that begins at `first`."""
    return found_layer(request, kwargs["layer"], "first" in kwargs, kwargs.get("first"))


def layer_start_place(request: Request, **kwargs: Any) -> Place:
    """The same, and of a layer that is too long the part with the first frame that is not done."""
    return found_layer(request, kwargs["layer"], True, kwargs.get("first"))


def found_layer(request: Request, pk: int, in_parts: bool, first: int | None) -> Place:
    found = layers_of(request.user).select_related("dataset").filter(pk=pk).first()
    if found is None:
        raise Http404
    assignment = Assignment.objects.select_related("batch__dataset").filter(layer=found).first()
    scope: dict[str, Any] = {"batches": assignment.batch_id} if assignment else {"dataset": found.dataset_id}
    part = parts.part_of(found, first) if in_parts else None
    if part:
        scope["number__range"] = (part.first, part.last)
    return Place(
        mode="layer",
        dataset=found.dataset,
        layer=found,
        frames=Frame.objects.filter(**scope).order_by("number"),
        author=cast(User, request.user),
        read_only_reason=_read_only_reason(request, found),
        assignment=assignment,
        part=part,
    )


def _read_only_reason(request: Request, layer: Layer) -> str:
    if layer.kind == Layer.Kind.ASSIGNMENT:
        return "not_author"
    # A script that works through layers must not get at what others are measured by, nor must a reviewer.
    if not isinstance(request.auth, ApiToken) and may(request.user, CARES, layer.dataset):
        return ""
    kept = layer.hidden or layer.kind in KEPT_KINDS or layer.releases.exists()
    return PROTECTED if kept else ""


# In a worker's assignment; with `as_view(**IN_LAYER)` in any layer, for staff. As a docstring this would be
# published with the schema.
class PlacedView(APIView):
    authentication_classes: Sequence[type[BaseAuthentication]] = [AssignmentAuthentication]
    permission_classes: Sequence[Any] = [HoldsAssignment]
    parser_classes = [BoundedJSONParser]
    write_role = SEES
    write_scope = ApiToken.Scope.WORK
    find: Callable[..., Place] = staticmethod(assignment_place)

    def place(self, **kwargs: Any) -> Place:
        return self.find(self.request, **kwargs)


IN_LAYER: dict[str, Any] = {
    "authentication_classes": [BearerAuthentication, StaffSession],
    "permission_classes": [StaffMay],
    "find": layer_place,
}


class TutorialPlace(APIView):
    authentication_classes = [WorkerAuthentication]
    permission_classes = [HoldsSeat]

    @property
    def worker(self) -> Worker:
        return cast(links.Seat, self.request.auth).worker
