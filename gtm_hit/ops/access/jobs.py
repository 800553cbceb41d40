"""Whose jobs one sees, stops and repeats: those that one could start."""

from __future__ import annotations

from django.db.models import Q, QuerySet
from django.utils.translation import gettext_lazy

from gtm_hit.models import Dataset, Job, Layer
from gtm_hit.ops import overview
from gtm_hit.ops.access.roles import (
    CARES,
    Role,
    Roles,
    Somebody,
    datasets_of,
    layers_of,
    may,
    may_everywhere,
)

IMPORTS = (Job.Kind.IMPORT_DATASET, Job.Kind.IMPORT_VIDEOS, Job.Kind.IMPORT_ANNOTATIONS)
NEEDED: dict[str, Roles] = {
    Job.Kind.EXPORT_LAYER: CARES,
    Job.Kind.MAKE_RELEASE: Role.MAINTAINER,
    Job.Kind.REPLACE_CALIBRATION: Role.MAINTAINER,
    Job.Kind.DRIFT: Role.MAINTAINER,
    Job.Kind.PROPOSE: Role.MAINTAINER,
    Job.Kind.SOLVE_LENS: Role.MAINTAINER,
    Job.Kind.ADJUST: Role.MAINTAINER,
    Job.Kind.SYNC_VIDEOS: Role.MAINTAINER,
    **dict.fromkeys(IMPORTS, Role.MAINTAINER),
}
NOT_YOURS = gettext_lazy(
    "You look after no dataset %(slug)s; making a new one takes a maintainer of all datasets."
)
OTHERWISE: Roles = Role.MANAGER  # work, quality and pay are the managers'


def jobs_of(user: Somebody) -> QuerySet[Job]:
    known = Q()
    for roles in {*NEEDED.values(), OTHERWISE}:
        known |= _of_kinds(roles) & _where(user, roles)
    return overview.jobs().filter(known).exclude(pk__in=_about_others_truth(user))


def may_import(user: Somebody, slug: str) -> bool:
    """Whether somebody may bring frames into this dataset; to make a new one takes the role for all."""
    dataset = Dataset.objects.filter(slug=slug).first()
    return may(user, Role.MAINTAINER, dataset) if dataset else may_everywhere(user, Role.MAINTAINER)


def _of_kinds(roles: Roles) -> Q:
    listed = Q(kind__in=[kind for kind, needed in NEEDED.items() if needed == roles])
    return listed | ~Q(kind__in=list(NEEDED)) if roles == OTHERWISE else listed


def _where(user: Somebody, roles: Roles) -> Q:
    if may_everywhere(user, roles):
        return Q()
    # An import that has not made its dataset yet is for those who may make one.
    return Q(dataset__in=datasets_of(user, roles))


def _about_others_truth(user: Somebody) -> QuerySet[Job]:
    """Exports and releases of layers that one may not read."""
    kept = Layer.objects.filter(hidden=True).exclude(pk__in=layers_of(user).values("pk"))
    layers = list(kept.values_list("pk", flat=True))
    return Job.objects.filter(parameters__layer_id__in=layers) if layers else Job.objects.none()
