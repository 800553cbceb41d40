"""The study that brings workers: drafted here, published, paused and looked at through the platform."""

from __future__ import annotations

import secrets
from dataclasses import replace

from django.contrib.auth.models import User
from django.utils.translation import gettext as _

from gtm_hit.models import Batch, Campaign, PlatformAccount
from gtm_hit.ops.campaigns import platform_settings
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.outbox import accounts
from gtm_hit.ops.outbox.platform import Platform, Study, StudyDraft
from gtm_hit.ops.outbox.statuses import STATUS_CHANGE

ACTIONS = ("publish", "pause", "resume", "stop")
SUBMISSION = "{{%SESSION_ID%}}"


class StudyError(OperationError):
    """The study stays as it is; the message says why."""


def proposed(campaign: Campaign, address: str = "") -> StudyDraft:
    """What the campaign's rules make of a study."""
    settings = settings_of(campaign)
    code = settings.code_completed or accounts.of(campaign).completion_code or secrets.token_hex(4).upper()
    return StudyDraft(
        title=campaign.title or campaign.name,
        description=campaign.instructions,
        address=with_placeholders(settings, address),
        places=Batch.objects.filter(campaign=campaign).count(),
        minutes=campaign.expected_minutes,
        reward=campaign.pay_per_batch,
        completion_code=code,
    )


def settings_of(campaign: Campaign) -> platform_settings.Prolific:
    """The usual ones for a campaign whose workers come by other ways."""
    found = platform_settings.read(campaign)
    return found if isinstance(found, platform_settings.Prolific) else platform_settings.Prolific()


def with_placeholders(settings: platform_settings.Prolific, address: str) -> str:
    """By the campaign's names of the parameters: without them nobody would know whose submission it is."""
    if not address or SUBMISSION in address:
        return address
    names = {
        settings.worker_parameter: "{{%PROLIFIC_PID%}}",
        settings.study_parameter: "{{%STUDY_ID%}}",
        settings.submission_parameter: SUBMISSION,
    }
    placed = "&".join(f"{name}={placeholder}" for name, placeholder in names.items())
    return f"{address}{'&' if '?' in address else '?'}{placed}"


def draft(campaign: Campaign, platform: Platform, wanted: StudyDraft, by: User | None) -> PlatformAccount:
    """Nobody sees a draft and nothing is paid for it. Raises StudyError, or what the platform says."""
    account = accounts.of(campaign)
    if account.study:
        raise StudyError(_("This campaign has a study already: %(study)s.") % {"study": account.study})
    settings = settings_of(campaign)
    require(wanted, settings)
    cleaned = replace(
        wanted,
        title=wanted.title.strip(),
        description=wanted.description.strip(),
        address=with_placeholders(settings, wanted.address.strip()),
    )
    return keep(account, platform.create_study(cleaned), by, wanted.completion_code)


def require(wanted: StudyDraft, settings: platform_settings.Prolific) -> None:
    if not wanted.title.strip() or not wanted.description.strip():
        raise StudyError(_("A study needs a title and a description."))
    if not wanted.address.startswith("https://"):
        raise StudyError(_("Workers need an address that begins with https://."))
    if wanted.places < 1 or wanted.minutes < 1 or wanted.reward <= 0:
        raise StudyError(_("Places, minutes and reward must be more than nothing."))
    if settings.code_completed and wanted.completion_code != settings.code_completed:
        text = _("Workers of this campaign come back with the code %(code)s: the study must take it.")
        raise StudyError(text % {"code": settings.code_completed})


def change(campaign: Campaign, platform: Platform, action: str, by: User | None) -> PlatformAccount:
    """`publish`, `pause`, `resume` or `stop`; publishing is what costs money."""
    account = existing(campaign)
    if action not in ACTIONS:
        raise StudyError(_("A study is published, paused, resumed or stopped."))
    return keep(account, platform.change_study(account.study, action), by)


def look(campaign: Campaign, platform: Platform) -> tuple[PlatformAccount, Study]:
    account = existing(campaign)
    study = platform.study(account.study)
    return keep(account, study, account.changed_by), study


def have_messages_sent(
    campaign: Campaign, platform: Platform, workspace: str, target: str, by: User | None
) -> PlatformAccount:
    """To our door, signed. A secret that is kept already is used on: a workspace has but one."""
    account = accounts.of(campaign)
    if not workspace or not target.startswith("https://"):
        raise StudyError(_("Messages need a workspace and an address that begins with https://."))
    if not account.hook_secret:
        account.hook_secret, account.changed_by = accounts.plain(platform.make_secret(workspace)), by
        account.save()
    platform.subscribe(workspace, STATUS_CHANGE, target)
    return account


def existing(campaign: Campaign) -> PlatformAccount:
    account = accounts.of(campaign)
    if not account.study:
        raise StudyError(_("There is no study yet."))
    return account


def keep(account: PlatformAccount, study: Study, by: User | None, code: str = "") -> PlatformAccount:
    account.study, account.study_state, account.changed_by = study.identifier, study.state[:40], by
    account.completion_code = code or account.completion_code
    account.save()
    return account
