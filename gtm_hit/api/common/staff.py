"""What the endpoints for staff and their scripts share: who may, pages of lists, things by their names."""

from __future__ import annotations

from typing import Any, TypeVar, cast

from django.contrib.auth.models import User
from django.db.models import Model, QuerySet
from django.http import Http404
from drf_spectacular.utils import OpenApiResponse
from rest_framework import exceptions, status
from rest_framework.pagination import PageNumberPagination
from rest_framework.request import Request
from rest_framework.serializers import Serializer
from rest_framework.views import APIView

from gtm_hit.api.common.authentication import BearerAuthentication, StaffMay, StaffSession
from gtm_hit.api.common.parsing import BoundedJSONParser
from gtm_hit.api.common.refusals import refusal, valid
from gtm_hit.models import ApiToken, Dataset, Layer
from gtm_hit.ops.access.roles import SEES, Role, Roles, layers_of

Row = TypeVar("Row", bound=Model)

READS = {401: refusal("not_signed_in"), 403: refusal("forbidden"), 404: refusal("not_found")}
ASKS = {400: refusal("invalid; details: a list of place and reason"), **READS}
WRITES = {
    **ASKS,
    400: refusal("invalid or unreadable; details: a list of place and reason"),
    413: refusal("too_large"),
    415: refusal("unsupported_media_type"),
}


def answers(status_code: int, shape: Any, refusals: dict[int, OpenApiResponse]) -> dict[int, Any]:
    return {status_code: shape, **refusals}


class Pages(PageNumberPagination):
    page_size = 100
    page_size_query_param = "page_size"
    max_page_size = 1000


class StaffView(APIView):
    authentication_classes = [BearerAuthentication, StaffSession]
    permission_classes = [StaffMay]
    parser_classes = [BoundedJSONParser]
    write_scope: ApiToken.Scope | None = None
    # Who may, for the dataset in the address; several: any of them is enough.
    read_role: Roles = SEES
    write_role: Roles = Role.ADMINISTRATOR
    # Where no dataset is in the address: whether the role for one of them is too little.
    everywhere = False


class ManagersView(StaffView):
    read_role = write_role = Role.MANAGER
    write_scope = ApiToken.Scope.WORK


class ReviewersView(StaffView):
    read_role = write_role = Role.REVIEWER
    write_scope = ApiToken.Scope.WORK


class Conflict(exceptions.APIException):
    status_code = status.HTTP_409_CONFLICT
    default_code = "under_way"


def caller(request: Request) -> User:
    """Whom StaffMay has let in."""
    return cast(User, request.user)


def asked(request: Request, query: type[Serializer[Any]]) -> dict[str, Any]:
    return valid(query(data=request.query_params))


def invalid(place: str, reason: object) -> exceptions.ValidationError:
    return exceptions.ValidationError({place: [str(reason)]})


def dataset_or_404(slug: str) -> Dataset:
    found = Dataset.objects.filter(slug=slug).first()
    if found is None:
        raise Http404
    return found


def named_or_404(rows: QuerySet[Row], name: str) -> Row:
    # PostgreSQL has no strings with a zero byte and fails instead of finding nothing.
    found = None if "\x00" in name else rows.filter(name=name).first()
    if found is None:
        raise Http404
    return found


def layer_or_404(request: Request, slug: str, name: str) -> Layer:
    return named_or_404(_layers(request, slug), name)


def layer_named(request: Request, dataset: Dataset, name: str, place: str) -> Layer:
    """A layer that a request names in its body or query."""
    found = _layers(request, dataset.slug).filter(name=name).first()
    if found is None:
        raise invalid(place, f"There is no layer {name}.")
    return found


def _layers(request: Request, slug: str) -> QuerySet[Layer]:
    """Those that the caller may read."""
    return layers_of(caller(request)).select_related("dataset").filter(dataset__slug=slug)
