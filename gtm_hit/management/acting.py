"""In whose name a command acts.

Whoever may run commands may do everything: they ask for no role. Only where a command acts in somebody's name
(`--as`, `--by`) that person must be allowed to do it: what is written down then could have been done so.
"""

from __future__ import annotations

from django.contrib.auth.models import User
from django.core.management.base import CommandError

from gtm_hit.models import Dataset
from gtm_hit.ops.access.granting import RoleError, user_named
from gtm_hit.ops.access.roles import Roles, may, may_everywhere, sufficient


def acting_as(username: str | None, roles: Roles, dataset: Dataset | None) -> User | None:
    """The person, or None for whoever runs the server; without a dataset the role must be for all."""
    if not username:
        return None
    try:
        user = user_named(username)
    except RoleError as error:
        raise CommandError(str(error)) from error
    if not (may(user, roles, dataset) if dataset else may_everywhere(user, roles)):
        where = f"dataset {dataset.slug}" if dataset else "all datasets"
        needed = " or ".join(sorted(sufficient(roles)))
        raise CommandError(f"{username} may not do that: it takes the role {needed} for {where}")
    return user
