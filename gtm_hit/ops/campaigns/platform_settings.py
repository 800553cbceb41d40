"""What a campaign's platform needs to know, checked: dataclasses read from Campaign.platform_settings."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any
from urllib.parse import urlsplit

from django.conf import settings
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns.errors import CampaignError

PARAMETER = re.compile(r"[A-Za-z][A-Za-z0-9_.-]{0,63}\Z")
CODE = re.compile(r"[A-Za-z0-9_-]{1,64}\Z")


@dataclass(frozen=True)
class OwnTeam:
    """Whoever works here has an account; nothing to set."""


@dataclass(frozen=True)
class SurveyLink:
    """`fixed_code`: the panel's own code, the same for everybody; empty: another one for each batch."""

    worker_parameter: str = "worker_id"
    fixed_code: str = ""
    return_address: str = ""


@dataclass(frozen=True)
class ExternalQuestion:
    """Origins (https://panel.example) that may show the page in a frame, and that take the last form."""

    frame_ancestors: tuple[str, ...] = ()
    submit_to: tuple[str, ...] = ()


@dataclass(frozen=True)
class Prolific:
    """Names of the parameters in the study's address, and one completion code per outcome."""

    worker_parameter: str = "PROLIFIC_PID"
    study_parameter: str = "STUDY_ID"
    submission_parameter: str = "SESSION_ID"
    completion_address: str = "https://app.prolific.com/submissions/complete"
    code_completed: str = ""
    code_no_work: str = ""
    code_not_admitted: str = ""


Settings = OwnTeam | SurveyLink | ExternalQuestion | Prolific
KINDS: Mapping[str, type[Settings]] = {
    Campaign.Platform.OWN_TEAM: OwnTeam,
    Campaign.Platform.LINK: SurveyLink,
    Campaign.Platform.EXTERNAL_QUESTION: ExternalQuestion,
    Campaign.Platform.PROLIFIC: Prolific,
}


def names(platform: str) -> list[str]:
    return [field.name for field in fields(KINDS[platform])]


def read(campaign: Campaign) -> Settings:
    """As they were checked when they were written."""
    return made(campaign.platform, campaign.platform_settings)


def made(platform: str, stored: Mapping[str, Any]) -> Settings:
    known: dict[str, Any] = {}
    for name in names(platform):
        if name in stored:
            # JSON has lists only.
            known[name] = tuple(stored[name]) if isinstance(stored[name], list) else stored[name]
    return KINDS[platform](**known)


def checked(platform: str, given: Mapping[str, Any], stored: Mapping[str, Any]) -> dict[str, Any]:
    """What is to be stored: `given` over what is there. Raises CampaignError naming the setting."""
    if platform not in KINDS:
        raise CampaignError(_("There is no platform “%(name)s”.") % {"name": platform}, "platform")
    known = names(platform)
    if unknown := sorted(set(given) - set(known) - set(stored)):
        told = ", ".join(known) or _("none")
        named = {"names": ", ".join(unknown), "known": told}
        raise CampaignError(
            _("This platform knows no setting %(names)s; there are: %(known)s.") % named, "platform_settings"
        )
    for name, value in given.items():
        if name in known and (problem := CHECKS[name](value)):
            raise CampaignError(f"{name}: {problem}", "platform_settings")
    return {**stored, **{name: list(v) if isinstance(v, tuple) else v for name, v in given.items()}}


def missing(campaign: Campaign) -> str:
    """What must be set before the campaign may open; empty when nothing is missing."""
    match read(campaign):
        case ExternalQuestion(frame_ancestors=ancestors, submit_to=submit_to):
            if not ancestors or not submit_to:
                return _("Name the origins that embed the page (frame_ancestors, submit_to).")
        case Prolific(code_completed=code):
            if not code:
                return _("Set the study's completion code (code_completed).")
    return ""


def parameter(value: Any) -> str:
    return "" if isinstance(value, str) and PARAMETER.match(value) else _("is no name of a parameter.")


def code(value: Any) -> str:
    if value == "" or (isinstance(value, str) and CODE.match(value)):
        return ""
    return _("a code has up to 64 letters, digits, - and _.")


def address(value: Any) -> str:
    if value == "" or (isinstance(value, str) and len(value) <= 500 and secure(value)):
        return ""
    return _("must be an address that begins with https://.")


def origins(value: Any) -> str:
    """Only origins that whoever runs the server allows as well."""
    if not isinstance(value, list | tuple) or not all(isinstance(one, str) for one in value):
        return _("must be a list of origins.")
    for one in value:
        if not secure(one) or origin_of(one) != one:
            return _("“%(one)s” is no origin; write https://panel.example.") % {"one": one}
        if one not in settings.EMBEDDING_ORIGINS:
            text = _("“%(one)s” is not allowed on this server; who runs it adds it to EMBEDDING_ORIGINS.")
            return text % {"one": one}
    return ""


def secure(value: str) -> bool:
    """https, or a server on this machine; without a name and password in it."""
    if not value.isascii() or re.search(r"[\s'\";,<>\\]", value):
        return False
    try:
        parts = urlsplit(value)
        _port = parts.port
    except ValueError:
        return False
    local = parts.scheme == "http" and (parts.hostname or "") in {"localhost", "127.0.0.1", "::1"}
    return bool(parts.hostname) and "@" not in parts.netloc and (parts.scheme == "https" or local)


def origin_of(value: str) -> str:
    parts = urlsplit(value)
    return f"{parts.scheme}://{parts.netloc}"


CHECKS: Mapping[str, Callable[[Any], str]] = {
    "worker_parameter": parameter,
    "study_parameter": parameter,
    "submission_parameter": parameter,
    "fixed_code": code,
    "code_completed": code,
    "code_no_work": code,
    "code_not_admitted": code,
    "completion_address": address,
    "return_address": address,
    "frame_ancestors": origins,
    "submit_to": origins,
}
