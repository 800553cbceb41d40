"""An open campaign over a small dataset."""

from __future__ import annotations

from typing import Any

from django.contrib.auth.models import User

from gtm_hit.models import Campaign, Dataset
from gtm_hit.ops.access import granting
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.campaigns import editing, states
from tests.work_scene import make_dataset

READY: dict[str, dict[str, Any]] = {
    "own_team": {},
    "link": {},
    "external_question": {
        "frame_ancestors": ["https://panel.example"],
        "submit_to": ["https://panel.example"],
    },
    "prolific": {"code_completed": "DONE1", "code_no_work": "NONE1", "code_not_admitted": "OUT1"},
}


def make_draft(dataset: Dataset | None = None, name: str = "walk", **values: Any) -> Campaign:
    platform = values.setdefault("platform", "link")
    values.setdefault("platform_settings", READY[platform])
    return editing.create(dataset or make_dataset(), {"name": name, **values})


def make_campaign(dataset: Dataset | None = None, name: str = "walk", **values: Any) -> Campaign:
    return states.take(make_draft(dataset, name, **values), "open")


def account(name: str, role: Role, dataset: Dataset) -> User:
    """Somebody with one role for one dataset."""
    user = User.objects.create_user(name)
    granting.grant(user, role, dataset)
    return user


def manager(dataset: Dataset) -> User:
    return account("manager", Role.MANAGER, dataset)
