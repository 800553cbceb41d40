"""Workers as their platforms name them. A platform's id is opaque and stays on the server."""

from __future__ import annotations

import unicodedata

from django.db.models import Exists, OuterRef
from django.utils.crypto import constant_time_compare
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Worker
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.work.digests import digest

MAX_ID = 255
MAX_PLATFORM = 40
UNBOUND = "-" * 64  # as long as a digest, and no digest
REFUSED = {"Cc", "Cs", "Zl", "Zp"}  # control characters, lone surrogates, line and paragraph separators


class InvalidWorkerId(OperationError, ValueError):
    """An id no platform gives out, or no platform; the message says why in plain words."""


class NotProven(OperationError):
    """An id alone is no proof: this browser is not the one its worker began in."""


def clean_external_id(text: str) -> str:
    """The id without the blanks that copying adds at its ends; raises InvalidWorkerId."""
    cleaned = text.strip()
    if not cleaned:
        raise InvalidWorkerId(_("The worker ID is missing."))
    if len(cleaned) > MAX_ID:
        raise InvalidWorkerId(_("A worker ID has at most %(most)d characters.") % {"most": MAX_ID})
    if any(unicodedata.category(character) in REFUSED for character in cleaned):
        raise InvalidWorkerId(_("The worker ID contains characters that cannot be printed."))
    return cleaned


def clean_platform(name: str) -> str:
    """Raises InvalidWorkerId."""
    if not name.isascii() or not name.replace("-", "").replace("_", "").isalnum():
        raise InvalidWorkerId(_("%(name)r is no platform: use letters, digits, - and _.") % {"name": name})
    if len(name) > MAX_PLATFORM:
        raise InvalidWorkerId(_("A platform's name has at most %(most)d letters.") % {"most": MAX_PLATFORM})
    return name


def find(platform: str, external_id: str) -> Worker | None:
    return Worker.objects.filter(platform=platform, external_id=clean_external_id(external_id)).first()


def enter(platform: str, external_id: str, secret: str = "") -> Worker:
    """The worker of a personal link; one row however often and at whatever moment he arrives.

    His first browser becomes his by it, so that nobody else can bind another one through the general link.
    """
    cleaned = clean_external_id(external_id)
    worker, _created = Worker.objects.get_or_create(platform=platform, external_id=cleaned)
    if secret:
        Worker.objects.filter(pk=worker.pk, browser="").update(browser=browser_digest(secret))
    return worker


def proven(platform: str, external_id: str, secret: str) -> Worker | None:
    """The worker with this id if the secret is that of his browser; what there is else is not told."""
    worker = find(platform, external_id)
    known = worker.browser if worker else ""
    return worker if constant_time_compare(known or UNBOUND, browser_digest(secret)) else None


def enter_by_general_link(platform: str, external_id: str, secret: str) -> Worker:
    """A new worker, bound to the browser with this secret, or the one bound to it before.

    Whoever entered before browsers were bound is bound now, unless there is work that somebody else could
    take. Raises NotProven.
    """
    cleaned = clean_external_id(external_id)
    own = browser_digest(secret)
    fresh = {"browser": own}
    worker, _created = Worker.objects.get_or_create(platform=platform, external_id=cleaned, defaults=fresh)
    if not worker.browser:
        work = Assignment.objects.filter(worker=OuterRef("pk"))
        Worker.objects.filter(~Exists(work), pk=worker.pk, browser="").update(**fresh)
        worker.refresh_from_db()
    if not constant_time_compare(worker.browser or UNBOUND, own):
        raise NotProven
    return worker


def browser_digest(secret: str) -> str:
    return digest("browser", secret)
