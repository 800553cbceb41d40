"""Workers as their platforms name them. A platform's id is opaque and stays on the server."""

from __future__ import annotations

import unicodedata

from django.utils.translation import gettext as _

from gtm_hit.models import Worker

MAX_ID = 255
MAX_PLATFORM = 40
REFUSED = {"Cc", "Cs", "Zl", "Zp"}  # control characters, lone surrogates, line and paragraph separators


class InvalidWorkerId(ValueError):
    """An id no platform gives out, or no platform; the message says why in plain words."""


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


def enter(platform: str, external_id: str) -> Worker:
    """The worker with this id; one row however often and at whatever moment he arrives."""
    cleaned = clean_external_id(external_id)
    worker, _created = Worker.objects.get_or_create(platform=platform, external_id=cleaned)
    return worker
