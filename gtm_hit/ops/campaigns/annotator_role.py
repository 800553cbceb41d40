"""How an account becomes an annotator of a dataset, where roles are given."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

from django.contrib.auth.models import User

from gtm_hit.models import Dataset
from gtm_hit.ops.access.roles import Role

GRANTING = "gtm_hit.ops.access.granting"


def make_annotator(user: User, dataset: Dataset) -> None:
    if find_spec(GRANTING):
        import_module(GRANTING).grant(user, Role.ANNOTATOR, dataset)
