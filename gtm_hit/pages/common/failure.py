"""The page for what went wrong on the server."""

from __future__ import annotations

import sys

from django.http import HttpRequest, HttpResponse
from django.shortcuts import render
from django.views.defaults import server_error

from gtm_hit.ops.files.full_disk import disk_full


def failed(request: HttpRequest) -> HttpResponse:
    """Called while the error is being handled."""
    if not disk_full(sys.exc_info()[1]):
        return server_error(request)
    # Without the request: the bar of the page asks the database who is signed in.
    return render(None, "507.html", status=507)
