from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User

from gtm_hit.crowd.prolific import connect
from gtm_hit.models import Assignment, Campaign, OutboxRow, Worker
from gtm_hit.ops.outbox import planning, sending
from tests.paid_campaign import assign, become, prolific_campaign
from tests.prolific_server import Prolific
from tests.work_scene import make_worker

REASON = (
    "Most of the people near the fountain were not marked in any of the ten frames of this batch. Look again."
)
State = Assignment.State


@pytest.fixture
def campaign(db: None, prolific: Prolific) -> Campaign:
    return prolific_campaign()


@pytest.fixture
def ada(db: None) -> Worker:
    return make_worker("ada", "prolific")


@pytest.fixture
def manager(db: None) -> User:
    return User.objects.create_user("manager", is_superuser=True)


@pytest.fixture
def work(campaign: Campaign, ada: Worker) -> Assignment:
    """Handed in, half an hour of it, under the submission s1."""
    return assign(campaign, ada, State.SUBMITTED, minutes=30, submission="s1")


def decide(work: Assignment, outcome: str, **values: Any) -> OutboxRow | None:
    return planning.plan_decision(become(work, outcome), outcome, **values)


def send(campaign: Campaign) -> sending.Report:
    return sending.send(campaign, connect(campaign), lambda done, total: None)


def hurry(campaign: Campaign) -> None:
    """The waits between attempts are over."""
    OutboxRow.objects.filter(campaign=campaign).update(not_before=None)


def states(campaign: Campaign) -> list[tuple[str, str]]:
    return list(OutboxRow.objects.filter(campaign=campaign).order_by("pk").values_list("kind", "state"))
