"""Every answer that is no success has one shape: `{"code", "message", "details"}`."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from dataclasses import asdict
from itertools import islice
from typing import Any

from django.core.exceptions import PermissionDenied
from django.core.signals import got_request_exception
from django.db import OperationalError
from django.http import Http404
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from rest_framework import exceptions, status
from rest_framework.response import Response
from rest_framework.views import set_rollback

from gtm_hit.formats.problems import MOST_PROBLEMS
from gtm_hit.ops.files.full_disk import disk_full
from gtm_hit.ops.frames.rules import InvalidFrame
from gtm_hit.ops.frames.saving import SaveIdUsed, StaleSave, UnknownRevision
from gtm_hit.ops.review.refusals import NotAllowed, ReviewRefused, WrongState
from gtm_hit.ops.sync.drafts import StaleDraft
from gtm_hit.ops.sync.whole import whole
from gtm_hit.ops.tutorial import lesson
from gtm_hit.ops.work import assignments

log = logging.getLogger(__name__)
MOST_QUOTED = 500

FULL = gettext_lazy("The server's disk is full; nothing was written. Whoever runs the server must make room.")
CODES = {
    status.HTTP_400_BAD_REQUEST: "invalid",
    status.HTTP_401_UNAUTHORIZED: "not_signed_in",
    status.HTTP_403_FORBIDDEN: "forbidden",
    status.HTTP_404_NOT_FOUND: "not_found",
    status.HTTP_405_METHOD_NOT_ALLOWED: "method_not_allowed",
    status.HTTP_406_NOT_ACCEPTABLE: "not_acceptable",
    status.HTTP_413_REQUEST_ENTITY_TOO_LARGE: "too_large",
    status.HTTP_415_UNSUPPORTED_MEDIA_TYPE: "unsupported_media_type",
}


def handle(error: Exception, context: dict[str, Any]) -> Response:
    response = domain_answer(error) or framework_answer(error) or unexpected_answer(error, context)
    set_rollback()
    return response


def answer(status_code: int, code: str, message: str, details: Any = None) -> Response:
    return Response({"code": code, "message": message, "details": details}, status=status_code)


def domain_answer(error: Exception) -> Response | None:
    match error:
        case StaleSave():
            message = _("The frame was saved elsewhere in the meantime.")
            return answer(412, "stale", message, {"current": error.current.as_dict()})
        case InvalidFrame():
            message = _("The frame cannot be saved like this.")
            return answer(400, "invalid", message, [asdict(problem) for problem in error.problems])
        case SaveIdUsed():
            return answer(409, "save_id_used", _("This save id belongs to another save."))
        case StaleDraft():
            return answer(412, "stale", str(error), {"current": whole(error.draft).as_json()})
        case UnknownRevision():
            return answer(404, "not_found", _("The frame never had this revision."))
        case assignments.ReadOnly():
            reason = {"reason": error.reason}
            return answer(403, "read_only", assignments.explained(error.reason), reason)
        case assignments.Unfinished():
            message = _("Some frames of the batch are not done yet.")
            return answer(409, "unfinished", message, {"frames": error.frames})
        case WrongState():
            return answer(409, error.code, str(error))
        case NotAllowed():
            return answer(403, error.code, str(error))
        case ReviewRefused():
            return answer(400, error.code, str(error), [{"place": "", "reason": str(error)}])
        case lesson.StepsMissing():
            message = _("Some steps of the tutorial are not done yet.")
            return answer(409, "unfinished", message, {"steps": error.steps})
        case lesson.NoTutorial():
            return answer(404, "not_found", _("There is no tutorial on this server."))
    return None


def framework_answer(error: Exception) -> Response | None:
    if isinstance(error, Http404):
        error = exceptions.NotFound()
    elif isinstance(error, PermissionDenied):
        error = exceptions.PermissionDenied()
    if not isinstance(error, exceptions.APIException):
        return None
    code = CODES.get(error.status_code, str(error.default_code))
    if isinstance(error, exceptions.ParseError):
        code = "unreadable"
    if isinstance(error, exceptions.ValidationError):
        problems = list(islice(flattened(error.detail), MOST_PROBLEMS))
        response = answer(error.status_code, code, _("The request is not valid."), problems)
    else:
        response = answer(error.status_code, code, str(error.detail))
    if challenge := getattr(error, "auth_header", None):
        response["WWW-Authenticate"] = challenge
    return response


def flattened(detail: Any, place: str = "") -> Iterator[dict[str, str]]:
    """DRF's nested validation messages as a list of places with reasons."""
    if isinstance(detail, dict):
        for key, value in detail.items():
            name = "" if key == "non_field_errors" else str(key)
            yield from flattened(value, ".".join(part for part in (place, name) if part))
    elif isinstance(detail, list):
        for item in detail:
            yield from flattened(item, place)
    else:
        # Places and reasons quote the request, which may be a megabyte of one word.
        yield {"place": place[:MOST_QUOTED], "reason": str(detail)[:MOST_QUOTED]}


def unexpected_answer(error: Exception, context: dict[str, Any]) -> Response:
    if disk_full(error):
        log.error("the disk is full: %s", error)
        return answer(507, "disk_full", str(FULL))
    if isinstance(error, OperationalError):
        log.warning("the database did not answer in time: %s", error)
        response = answer(503, "busy", _("The server is busy; nothing was written. Try again."))
        response["Retry-After"] = "2"
        return response
    log.error("unexpected error in %s", context.get("view"), exc_info=error)
    got_request_exception.send(sender=handle, request=context.get("request"))
    return answer(500, "error", _("The server made a mistake; it has been noted."))
