"""Who may do what: five roles, each for one dataset or for all of them.

A group of Django's with a role's name has it for all datasets, `Membership` for one. Superusers are
administrators. `is_staff` opens Django's own admin and nothing else.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum

from django.contrib.auth.models import AnonymousUser, User
from django.db.models import Q, QuerySet

from gtm_hit.models import Dataset, Layer, Membership, Role

__all__ = ["CARES", "KNOWS", "SEES", "Role", "Roles", "Somebody", "may"]

# One role, or several of which any is enough.
Roles = Role | tuple[Role, ...]
Somebody = User | AnonymousUser

# Who sees a dataset: its pictures, layers, figures and releases. Managers are reviewers.
SEES: Roles = (Role.REVIEWER, Role.MAINTAINER)
# Who works with layers as a whole: exports them, changes what was imported.
CARES: Roles = (Role.MANAGER, Role.MAINTAINER)
# Who may know the truth that is hidden from workers and reviewers alike.
KNOWS: Roles = Role.MANAGER

_IMPLYING = {Role.REVIEWER: Role.MANAGER}
_CACHE = "_roles_held"


class Verdict(Enum):
    MAY = "may"
    MAY_NOT = "may not"
    HIDDEN = "hidden"  # whether there is such a dataset is not told


@dataclass(frozen=True)
class Held:
    """The roles of one person."""

    everywhere: frozenset[str] = frozenset()
    per_dataset: Mapping[int, frozenset[str]] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.everywhere or self.per_dataset)

    def datasets(self, enough: frozenset[str]) -> list[int]:
        return [dataset for dataset, roles in self.per_dataset.items() if roles & enough]


def may(user: Somebody, roles: Roles, dataset: Dataset | None = None) -> bool:
    """Whether somebody may do what takes one of these roles; without a dataset: for any dataset at all."""
    mine, enough = held(user), sufficient(roles)
    if mine.everywhere & enough:
        return True
    if dataset is None:
        return bool(mine.datasets(enough))
    return bool(mine.per_dataset.get(dataset.pk, frozenset()) & enough)


def may_everywhere(user: Somebody, roles: Roles) -> bool:
    """For what belongs to no dataset, or to all of them."""
    return bool(held(user).everywhere & sufficient(roles))


def verdict(user: Somebody, roles: Roles, dataset: Dataset | None) -> Verdict:
    """About something in a dataset, or in one that is not there (None).

    Whoever has no role for a dataset gets the same answer as if there were none.
    """
    if dataset is not None and may(user, roles, dataset):
        return Verdict.MAY
    mine = held(user)
    known = dataset is not None and (mine.everywhere or dataset.pk in mine.per_dataset)
    return Verdict.HIDDEN if mine and not known else Verdict.MAY_NOT


def has_role(user: Somebody) -> bool:
    return bool(held(user))


def datasets_of(user: Somebody, roles: Roles = SEES) -> QuerySet[Dataset]:
    mine, enough = held(user), sufficient(roles)
    if mine.everywhere & enough:
        return Dataset.objects.all()
    return Dataset.objects.filter(pk__in=mine.datasets(enough))


def layers_of(user: Somebody) -> QuerySet[Layer]:
    """The layers somebody may read: hidden ones only where he may know the truth."""
    return Layer.objects.filter(readable(user))


def readable(user: Somebody) -> Q:
    """The same, as a condition on layers."""
    mine, enough = held(user), sufficient(KNOWS)
    if mine.everywhere & enough:
        return Q()
    knows = Q(hidden=False) | Q(dataset__in=mine.datasets(enough))
    if mine.everywhere & sufficient(SEES):
        return knows
    return knows & Q(dataset__in=mine.datasets(sufficient(SEES)))


def may_know(user: Somebody, dataset: Dataset) -> bool:
    """Whether somebody may read the dataset's hidden layers."""
    return may(user, KNOWS, dataset)


def held(user: Somebody) -> Held:
    """Two queries for each user object, as Django does it with permissions."""
    if isinstance(user, AnonymousUser) or not user.is_active:
        return Held()
    if not hasattr(user, _CACHE):
        setattr(user, _CACHE, _held(user))
    found: Held = getattr(user, _CACHE)
    return found


def forget(user: Somebody) -> None:
    """After a change of roles."""
    user.__dict__.pop(_CACHE, None)


def sufficient(roles: Roles) -> frozenset[str]:
    """Every role with which one may do what takes one of these."""
    wanted = (roles,) if isinstance(roles, Role) else roles
    implying = {_IMPLYING[role] for role in wanted if role in _IMPLYING}
    return frozenset(role.value for role in {*wanted, *implying, Role.ADMINISTRATOR})


def _held(user: User) -> Held:
    if user.is_superuser:
        return Held(frozenset({Role.ADMINISTRATOR.value}))
    groups = user.groups.filter(name__in=Role.values).values_list("name", flat=True)
    rows = Membership.objects.filter(user=user).values_list("dataset_id", "role")
    return Held(frozenset(groups), _by_dataset(rows))


def _by_dataset(rows: Iterable[tuple[int, str]]) -> dict[int, frozenset[str]]:
    found: dict[int, frozenset[str]] = {}
    for dataset, role in rows:
        found[dataset] = found.get(dataset, frozenset()) | {role}
    return found
