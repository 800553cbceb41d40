"""Giving and taking roles; every change is written down."""

from __future__ import annotations

from dataclasses import dataclass

from django.contrib.auth.models import Group, User
from django.db import transaction
from django.db.models import QuerySet
from django.utils.translation import gettext as _

from gtm_hit.models import Dataset, Membership, RoleChange
from gtm_hit.ops.access.roles import Role, forget, may, may_everywhere
from gtm_hit.ops.errors import OperationError


class RoleError(OperationError, ValueError):
    """A role that cannot be given or taken; says why."""


@dataclass(frozen=True)
class Holding:
    """One role of one person; without a dataset: for all of them."""

    user: User
    role: Role
    dataset: Dataset | None
    by_account: bool = False  # a superuser's: it cannot be taken without changing the account


def grant(user: User, role: Role, dataset: Dataset | None = None, by: User | None = None) -> bool:
    """Give a role, for one dataset or for all; `by` nobody: whoever runs the server. False: had it already.

    Raises RoleError when `by` may not.
    """
    _refuse_others(by, dataset)
    if not user.is_active:
        raise RoleError(_("The account %(name)s is switched off.") % {"name": user.get_username()})
    with transaction.atomic():
        if not _add(user, role, dataset):
            return False
        _write_down(user, role, dataset, by, granted=True)
    forget(user)
    return True


def revoke(user: User, role: Role, dataset: Dataset | None = None, by: User | None = None) -> bool:
    """Take a role. False: did not have it. Raises RoleError when `by` may not, or would lock himself out."""
    _refuse_others(by, dataset)
    if by is not None and by.pk == user.pk and role == Role.ADMINISTRATOR:
        raise RoleError(_("Nobody gives up their own administrator's role: ask another administrator."))
    with transaction.atomic():
        if not _remove(user, role, dataset):
            return False
        _write_down(user, role, dataset, by, granted=False)
    forget(user)
    return True


def user_named(name: str) -> User:
    """Raises RoleError."""
    found = User.objects.filter(username=name).first() if "\x00" not in name else None
    if found is None:
        raise RoleError(_("There is no account %(name)s.") % {"name": name})
    return found


def holdings(dataset: Dataset | None) -> list[Holding]:
    """Who has which role: for one dataset, or for all datasets. The few who may much come first."""
    if dataset is None:
        return sorted(_everywhere(), key=_importance)
    rows = Membership.objects.filter(dataset=dataset).select_related("user", "dataset")
    return sorted((Holding(row.user, Role(row.role), row.dataset) for row in rows), key=_importance)


def _importance(holding: Holding) -> tuple[int, str]:
    return -list(Role).index(holding.role), holding.user.get_username()


def _everywhere() -> list[Holding]:
    groups = Group.objects.filter(name__in=Role.values).prefetch_related("user_set")
    found = [Holding(user, Role(group.name), None) for group in groups for user in group.user_set.all()]
    named = {(each.user.pk, each.role) for each in found}
    superusers = User.objects.filter(is_superuser=True, is_active=True)
    found += [
        Holding(user, Role.ADMINISTRATOR, None, by_account=True)
        for user in superusers
        if (user.pk, Role.ADMINISTRATOR) not in named
    ]
    return found


def changes(dataset: Dataset | None) -> QuerySet[RoleChange]:
    """The newest first."""
    return RoleChange.objects.filter(dataset=dataset.slug if dataset else "").order_by("-at", "-pk")


def _refuse_others(by: User | None, dataset: Dataset | None) -> None:
    if by is None:
        return
    if not (may(by, Role.ADMINISTRATOR, dataset) if dataset else may_everywhere(by, Role.ADMINISTRATOR)):
        raise RoleError(_("Only an administrator gives and takes roles."))


def _add(user: User, role: Role, dataset: Dataset | None) -> bool:
    if dataset is not None:
        return Membership.objects.get_or_create(user=user, role=role.value, dataset=dataset)[1]
    group, _made = Group.objects.get_or_create(name=role.value)
    if user.groups.filter(pk=group.pk).exists():
        return False
    user.groups.add(group)
    return True


def _remove(user: User, role: Role, dataset: Dataset | None) -> bool:
    if dataset is not None:
        return bool(Membership.objects.filter(user=user, role=role.value, dataset=dataset).delete()[0])
    group = user.groups.filter(name=role.value).first()
    if group is None:
        return False
    user.groups.remove(group)
    return True


def _write_down(user: User, role: Role, dataset: Dataset | None, by: User | None, *, granted: bool) -> None:
    RoleChange.objects.create(
        by=by.get_username() if by else "",
        username=user.get_username(),
        role=role.value,
        dataset=dataset.slug if dataset else "",
        granted=granted,
    )
