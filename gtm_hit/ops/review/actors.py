"""Who takes a step: staff, the worker whose work it is, or the system. Nobody reviews their own work."""

from __future__ import annotations

from django.contrib.auth.models import User
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Campaign, Worker
from gtm_hit.ops.access.roles import Role, may
from gtm_hit.ops.review.refusals import NotAllowed, OwnWork

Actor = User | Worker | None  # None: the system


def own_work(user: User, worker: Worker) -> bool:
    """Whether the worker is this user, by what the platform calls him.

    On other platforms ids are free texts: who entered his user name or address there is taken at his word.
    """
    names = {user.get_username(), user.email}
    if worker.platform == Campaign.Platform.OWN_TEAM:
        names.add(str(user.pk))
    return worker.external_id.casefold() in {name.casefold() for name in names if name}


def require_worker(assignment: Assignment, by: Actor) -> None:
    if not isinstance(by, Worker) or by.pk != assignment.worker_id:
        raise NotAllowed(_("Only the worker who did the batch does this."))


def require_reviewer(assignment: Assignment, by: Actor) -> None:
    if not isinstance(by, User) or not may(by, Role.REVIEWER, assignment.batch.dataset):
        raise NotAllowed(_("Only reviewers of this dataset do this."))
    if own_work(by, assignment.worker):
        raise OwnWork(_("This is your own work: somebody else has to review it."))


def require_system(assignment: Assignment, by: Actor) -> None:
    if by is not None:
        raise NotAllowed(_("Only the system does this."))
