"""The one door for accounts: failed tries are limited and logged, and the answer says when to try again."""

from __future__ import annotations

import logging
from datetime import timedelta
from typing import Any

from django.contrib.auth.forms import AuthenticationForm
from django.contrib.auth.views import LoginView
from django.core.exceptions import ValidationError
from django.http import HttpResponse
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.ops.work.limits import Limit, forget
from gtm_hit.pages.common.address import client_address

log = logging.getLogger(__name__)

SPAN = timedelta(minutes=15)
# One name from one address, everybody at one address, one name from everywhere.
PAIR, ADDRESS, NAME = Limit("login", 8, SPAN), Limit("login from", 60, SPAN), Limit("login as", 100, SPAN)


class LimitedForm(AuthenticationForm):
    """Passwords are hashed, which is slow on purpose, only for those who may try."""

    wait: timedelta | None = None

    @property
    def limited(self) -> bool:
        return self.wait is not None

    def clean(self) -> dict[str, Any]:
        assert self.request is not None
        name, address = self.cleaned_data.get("username", "").casefold(), client_address(self.request)
        limits = [(PAIR, (name, address)), (ADDRESS, (address,)), (NAME, (name,))]
        waits = [wait for limit, parts in limits if (wait := limit.wait(*parts))]
        if waits:
            self.wait = max(waits)
            log.warning("login refused after too many failures: %r from %s", name, address)
            raise ValidationError(try_again(self.wait))
        # Counted before the password is looked at: a hundred at once are a hundred.
        tries = [limit.count(*parts) for limit, parts in limits]
        try:
            cleaned = super().clean()
        except ValidationError:
            log.warning("login failed: %r from %s", name, address)
            raise
        forget(tries)
        PAIR.clear(name, address)
        log.info("login: %r from %s", name, address)
        return cleaned


def try_again(wait: timedelta) -> str:
    at = timezone.localtime(timezone.now() + wait + timedelta(minutes=1))
    return _("Too many failed attempts. Try again at %(time)s, %(zone)s.") % {
        "time": at.strftime("%H:%M"),
        "zone": timezone.get_current_timezone_name(),
    }


class LimitedLogin(LoginView):
    template_name = "login.html"
    authentication_form = LimitedForm

    def form_invalid(self, form: Any) -> HttpResponse:
        response = super().form_invalid(form)
        if form.limited:
            response.status_code = 429
            response["Retry-After"] = str(int(form.wait.total_seconds()) + 1)
        return response
