"""What the endpoints of a desk share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from django.http import Http404
from rest_framework import serializers
from rest_framework.request import Request

from gtm_hit.api.common.parsing import BoundedMultiPartParser
from gtm_hit.api.common.refusals import valid
from gtm_hit.api.common.staff import StaffView, caller, invalid
from gtm_hit.api.datasets.importing import refused
from gtm_hit.formats.problems import FormatError
from gtm_hit.models import ApiToken, Desk
from gtm_hit.ops.access.desks import desks_of
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk.errors import DeskError, NotThere
from gtm_hit.ops.desk.pictures import MOST_BYTES


class DeskView(StaffView):
    read_role = write_role = Role.MAINTAINER
    write_scope = ApiToken.Scope.IMPORT


class DeskFileParser(BoundedMultiPartParser):
    def most_bytes(self) -> int:
        return MOST_BYTES


class FileOfDeskSerializer(serializers.Serializer[Any]):
    file = serializers.FileField()


def desk_or_404(request: Request, slug: str) -> Desk:
    found = desks_of(caller(request)).select_related("dataset").filter(slug=slug).first()
    if found is None:
        raise Http404
    return found


@contextmanager
def told(place: str = "") -> Iterator[None]:
    """What an operation refuses, as the answer's details."""
    try:
        yield
    except NotThere as error:
        raise Http404 from error
    except DeskError as error:
        raise invalid(place, error) from error
    except FormatError as error:
        raise refused(place or "file", error) from error


def sent_file(request: Request) -> tuple[bytes, str]:
    """Bytes and name of the one file of a form."""
    file = valid(FileOfDeskSerializer(data=request.data))["file"]
    return file.read(), file.name or "file"
