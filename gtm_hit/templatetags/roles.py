"""What a page shows follows from what somebody may; whether he may is asked again where he does it."""

from __future__ import annotations

from typing import Any

from django import template

from gtm_hit.models import Dataset
from gtm_hit.ops.access import roles
from gtm_hit.ops.access.roles import Role, Roles

register = template.Library()

NAMED: dict[str, Roles] = {
    **{role.value: role for role in Role},
    "sees": roles.SEES,
    "cares": roles.CARES,
    "knows": roles.KNOWS,
}


@register.simple_tag(takes_context=True)
def may(context: template.Context, name: str, dataset: Dataset | None = None) -> bool:
    """`{% may "manager" dataset as manages %}`; without a dataset: for any of them."""
    user: Any = context.get("user")
    return user is not None and roles.may(user, NAMED[name], dataset)


@register.simple_tag(takes_context=True)
def may_everywhere(context: template.Context, name: str) -> bool:
    user: Any = context.get("user")
    return user is not None and roles.may_everywhere(user, NAMED[name])
