"""Views that take large files."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from django.contrib import messages
from django.http import HttpRequest, HttpResponseBase
from django.shortcuts import redirect
from django.utils.translation import gettext as _
from django.views.decorators.csrf import csrf_exempt, csrf_protect

from gtm_hit.ops.access.roles import Roles
from gtm_hit.ops.files import sources
from gtm_hit.pages.common.access import View, needs

FORM_BYTES = 1_000_000  # of the other fields, generously


def takes_uploads(roles: Roles) -> Callable[[View], View]:
    """For who has a role, and no more bytes than are accepted: both asked before the body is read.

    Django's own middleware would look for the token in the body first, and take in all of it from anybody.
    """

    def guard(view: View) -> View:
        protected = csrf_protect(view)

        @csrf_exempt
        @needs(roles)
        @wraps(view)
        def guarded(request: HttpRequest, *args: Any, **kwargs: Any) -> HttpResponseBase:
            # A body without a length is none for Django.
            length = int(request.META.get("CONTENT_LENGTH") or 0)
            if length > sources.most_bytes() + FORM_BYTES:
                size = sources.most_bytes() // sources.MEGABYTE
                messages.error(request, _("The file is larger than %(size)d MB.") % {"size": size})
                return redirect(request.get_full_path())
            return protected(request, *args, **kwargs)

        return guarded

    return guard
