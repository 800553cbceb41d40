"""How a campaign reaches its platform. Keys go in and never come out again."""

from __future__ import annotations

from django.conf import settings
from django.contrib.auth.models import User
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, PlatformAccount
from gtm_hit.ops.errors import OperationError

FORGET = "-"  # in the place of a key or a secret: there shall be none


class AccountError(OperationError):
    """An address or a key that is none, or not allowed here."""


def of(campaign: Campaign) -> PlatformAccount:
    """A campaign nobody set up has no row."""
    return PlatformAccount.objects.filter(campaign=campaign).first() or PlatformAccount(campaign=campaign)


def address(account: PlatformAccount) -> str:
    """Raises AccountError: what the operator took out of the list is not asked any more."""
    known = settings.PROLIFIC_ADDRESSES
    chosen = account.address or (known[0] if known else "")
    if chosen not in known:
        raise AccountError(_("This server may not ask %(address)s.") % {"address": chosen or "-"})
    return chosen


def key(account: PlatformAccount) -> str:
    """The campaign's, else the server's own, which goes to the first address only. Raises AccountError."""
    if account.token:
        return account.token
    if settings.PROLIFIC_TOKEN and address(account) == settings.PROLIFIC_ADDRESSES[0]:
        return settings.PROLIFIC_TOKEN
    raise AccountError(_("There is no key for the platform: everything goes by files."))


def has_key(account: PlatformAccount) -> bool:
    try:
        return bool(key(account))
    except AccountError:
        return False


def configure(
    campaign: Campaign,
    by: User | None,
    *,
    address: str = "",
    token: str = "",
    hook_secret: str = "",
    study: str = "",
) -> PlatformAccount:
    """Empty key or secret: as before. Raises AccountError."""
    if address and address not in settings.PROLIFIC_ADDRESSES:
        raise AccountError(_("This server may not ask %(address)s.") % {"address": address})
    account = of(campaign)
    account.address, account.study, account.changed_by = address, plain(study), by
    account.token = changed(account.token, token)
    account.hook_secret = changed(account.hook_secret, hook_secret)
    account.save()
    return account


def changed(before: str, given: str) -> str:
    return before if not given else "" if given == FORGET else plain(given)


def plain(text: str) -> str:
    """It becomes part of a header or an address. Raises AccountError."""
    cleaned = text.strip()
    if cleaned and not (cleaned.isascii() and cleaned.isprintable() and " " not in cleaned):
        raise AccountError(_("Keys and ids consist of letters, digits and signs without blanks."))
    return cleaned
