"""Who may see and change which desk: the maintainers of its dataset; without one, those of all datasets."""

from __future__ import annotations

from django.db.models import Q, QuerySet

from gtm_hit.models import Dataset, Desk
from gtm_hit.ops.access.roles import Role, Roles, Somebody, Verdict, datasets_of, may, may_everywhere, verdict


def desks_of(user: Somebody) -> QuerySet[Desk]:
    """Those somebody may see and change."""
    own = Q(dataset__in=datasets_of(user, Role.MAINTAINER))
    if may_everywhere(user, Role.MAINTAINER):
        own |= Q(dataset__isnull=True)
    return Desk.objects.filter(own)


def may_make_desk(user: Somebody, dataset: Dataset | None) -> bool:
    """Cameras of a dataset that is not there are the business of who may import a new one."""
    return may_everywhere(user, Role.MAINTAINER) if dataset is None else may(user, Role.MAINTAINER, dataset)


def desk_verdict(user: Somebody, roles: Roles, slug: str) -> Verdict:
    """About the desk of this name, be it there or not."""
    desk = Desk.objects.select_related("dataset").filter(slug=slug).first()
    if desk is not None and desk.dataset is None and may_everywhere(user, roles):
        return Verdict.MAY
    return verdict(user, roles, desk.dataset if desk else None)
