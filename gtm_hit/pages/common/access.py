from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from django.contrib.auth.models import User
from django.contrib.auth.views import redirect_to_login
from django.core.exceptions import PermissionDenied
from django.http import HttpRequest, HttpResponseBase
from django.urls import reverse

from gtm_hit.models import Dataset
from gtm_hit.ops.access.roles import Role, may

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


def needs(role: Role) -> Callable[[View], View]:
    """Only for who has the role for the dataset in the address (`slug`), or for any if there is none.

    Strangers are sent to the login page; who is known but may not gets 403.
    """

    def guard(view: View) -> View:
        @wraps(view)
        def guarded(request: HttpRequest, *args: Any, **kwargs: Any) -> HttpResponseBase:
            if not request.user.is_authenticated:
                return staff_only(view)(request, *args, **kwargs)
            dataset = Dataset.objects.filter(slug=kwargs["slug"]).first() if "slug" in kwargs else None
            if not may(request.user, role, dataset):
                raise PermissionDenied
            return view(request, *args, **kwargs)

        return guarded

    return guard
