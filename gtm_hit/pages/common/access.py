from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from django.contrib.auth.models import User
from django.contrib.auth.views import redirect_to_login
from django.http import HttpRequest, HttpResponseBase
from django.urls import reverse

View = Callable[..., HttpResponseBase]


class StaffRequest(HttpRequest):
    """What a view behind `staff_only` is called with."""

    user: User


def staff_only(view: View) -> View:
    """Everybody else is sent to the login page, and from there back to the page asked for."""

    @wraps(view)
    def guarded(request: HttpRequest, *args: Any, **kwargs: Any) -> HttpResponseBase:
        if request.user.is_active and request.user.is_staff:
            return view(request, *args, **kwargs)
        # A form cannot be sent again after the login, so its address is no place to return to.
        wanted = request.get_full_path() if request.method in {"GET", "HEAD"} else reverse("home")
        return redirect_to_login(wanted)

    return guarded
