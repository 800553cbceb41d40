"""What addresses about a campaign share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rest_framework import exceptions, status

from gtm_hit.api.common.refusals import refusal
from gtm_hit.api.common.staff import READS, WRITES, Conflict, named_or_404
from gtm_hit.models import Campaign
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.outbox.platform import PlatformError

REFUSED = {409: refusal("conflict; the message says why")}
READS_REFUSED = {**READS, **REFUSED}
ACTS = {**WRITES, **REFUSED}
ASKS_PLATFORM = {**ACTS, 502: refusal("platform; what the platform said, or that it did not answer")}


class NotNow(Conflict):
    default_code = "conflict"


class PlatformFailed(exceptions.APIException):
    status_code = status.HTTP_502_BAD_GATEWAY
    default_code = "platform"


@contextmanager
def refusals() -> Iterator[None]:
    """What an operation refuses is a conflict with how things are; the platform's refusals are told apart."""
    try:
        yield
    except PlatformError as error:
        raise PlatformFailed(str(error)) from error
    except OperationError as error:
        raise NotNow(str(error)) from error


def campaign_or_404(slug: str, name: str) -> Campaign:
    """With its dataset."""
    return named_or_404(Campaign.objects.select_related("dataset").filter(dataset__slug=slug), name)
