from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from django.contrib.auth.models import User
from django.contrib.auth.views import redirect_to_login
from django.core.exceptions import PermissionDenied
from django.http import Http404, HttpRequest, HttpResponseBase
from django.urls import reverse
from django.utils.translation import gettext as _

from gtm_hit.models import Dataset
from gtm_hit.ops.access.desks import desk_verdict
from gtm_hit.ops.access.roles import Roles, Verdict, may, may_everywhere, verdict

View = Callable[..., HttpResponseBase]


class StaffRequest(HttpRequest):
    """What a view behind `needs` is called with."""

    user: User


def to_login(request: HttpRequest) -> HttpResponseBase:
    """And from there back to the page asked for."""
    # A form cannot be sent again after the login, so its address is no place to return to.
    wanted = request.get_full_path() if request.method in {"GET", "HEAD"} else reverse("home")
    return redirect_to_login(wanted)


def needs(roles: Roles, write: Roles | None = None, everywhere: bool = False) -> Callable[[View], View]:
    """Only for who has one of the roles for the dataset in the address (`slug`), or for any if there is none.

    An address of a calibration desk (`desk`) is its dataset's; without a dataset it takes the role for all.

    `write`: what anything but reading takes. `everywhere`: the role for one dataset is not enough.
    Strangers are sent to the login page; who is known but may not gets 403, and 404 for a dataset he has
    nothing to do with.
    """

    def guard(view: View) -> View:
        @wraps(view)
        def guarded(request: HttpRequest, *args: Any, **kwargs: Any) -> HttpResponseBase:
            if not request.user.is_authenticated:
                return to_login(request)
            reads = request.method in {"GET", "HEAD"}
            refuse_unless_may(request, roles if reads or write is None else write, everywhere, **kwargs)
            return view(request, *args, **kwargs)

        return guarded

    return guard


def refuse_unless_may(request: HttpRequest, roles: Roles, everywhere: bool = False, **address: Any) -> None:
    if "desk" in address:
        told = desk_verdict(request.user, roles, address["desk"])
        if told is Verdict.HIDDEN:
            raise Http404(_("There is no desk “%(slug)s”.") % {"slug": address["desk"]})
        if told is Verdict.MAY_NOT:
            raise PermissionDenied
        return
    if "slug" not in address:
        if not (may_everywhere if everywhere else may)(request.user, roles):
            raise PermissionDenied
        return
    slug = address["slug"]
    found = verdict(request.user, roles, Dataset.objects.filter(slug=slug).first())
    if found is Verdict.HIDDEN:
        raise Http404(_("There is no dataset “%(slug)s”.") % {"slug": slug})
    if found is Verdict.MAY_NOT:
        raise PermissionDenied
