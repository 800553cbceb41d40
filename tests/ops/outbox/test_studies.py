from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from django.contrib.auth.models import User

from gtm_hit.crowd.prolific import connect
from gtm_hit.models import Campaign, PlatformAccount
from gtm_hit.ops.campaigns.platform_settings import Prolific as Settings
from gtm_hit.ops.outbox import studies
from gtm_hit.ops.outbox.platform import Refused
from tests.prolific_server import Prolific


@pytest.fixture
def fresh(campaign: Campaign) -> Campaign:
    PlatformAccount.objects.update(study="")
    campaign.title, campaign.instructions = "Mark people", "Seven views of a square."
    campaign.save()
    return campaign


def draft(campaign: Campaign, **values: Any) -> PlatformAccount:
    wanted = replace(studies.proposed(campaign, "https://gtm.example/join/x/"), **values)
    return studies.draft(campaign, connect(campaign), wanted, None)


def test_a_study_is_drafted_from_the_campaigns_rules(fresh: Campaign, prolific: Prolific) -> None:
    account = draft(fresh)
    made = prolific.studies[account.study]
    assert (made["total_available_places"], made["reward"], made["estimated_completion_time"]) == (6, 200, 15)
    assert made["external_study_url"].startswith(
        "https://gtm.example/join/x/?PROLIFIC_PID={{%PROLIFIC_PID%}}&"
    )
    assert made["completion_codes"][0]["code"] == account.completion_code


def test_a_study_names_parameters_and_code_as_the_campaigns_rules_do(
    fresh: Campaign, prolific: Prolific
) -> None:
    fresh.platform_settings = {"submission_parameter": "piece", "code_completed": "DONE1"}
    fresh.save()
    made = prolific.studies[draft(fresh).study]
    assert made["external_study_url"].endswith("&piece={{%SESSION_ID%}}")
    assert made["completion_codes"][0]["code"] == "DONE1"


def test_a_code_that_workers_do_not_bring_is_refused(fresh: Campaign, prolific: Prolific) -> None:
    fresh.platform_settings = {"code_completed": "DONE1"}
    fresh.save()
    with pytest.raises(studies.StudyError, match="DONE1"):
        draft(fresh, completion_code="OTHER")
    assert prolific.count("POST /api/v1/studies/") == 0


def test_a_second_draft_is_refused(fresh: Campaign, prolific: Prolific) -> None:
    draft(fresh)
    with pytest.raises(studies.StudyError, match="already"):
        draft(fresh)
    assert prolific.count("POST /api/v1/studies/") == 1


@pytest.mark.parametrize(
    "values", [{"title": " "}, {"description": ""}, {"address": "http://x"}, {"places": 0}, {"reward": 0}]
)
def test_half_a_draft_is_not_sent(fresh: Campaign, prolific: Prolific, values: dict[str, Any]) -> None:
    with pytest.raises(studies.StudyError):
        draft(fresh, **values)
    assert prolific.asked == []


def test_it_is_published_paused_and_looked_at(fresh: Campaign, manager: User) -> None:
    draft(fresh)
    mine = connect(fresh)
    assert studies.change(fresh, mine, "publish", manager).study_state == "ACTIVE"
    with pytest.raises(Refused):
        studies.change(fresh, mine, "publish", manager)
    assert studies.change(fresh, mine, "pause", manager).study_state == "PAUSED"
    assert studies.look(fresh, mine)[1].places == 6


def test_what_is_not_there_cannot_be_published(fresh: Campaign) -> None:
    with pytest.raises(studies.StudyError):
        studies.change(fresh, connect(fresh), "publish", None)
    draft(fresh)
    with pytest.raises(studies.StudyError):
        studies.change(fresh, connect(fresh), "explode", None)


def test_messages_are_subscribed_to_confirmed_and_signed_with_one_secret(
    fresh: Campaign, prolific: Prolific
) -> None:
    doors = ["https://gtm.example/hooks/a/", "https://gtm.example/hooks/b/"]
    for door in doors:
        studies.have_messages_sent(fresh, connect(fresh), "w1", door, None)
    kept = list(prolific.subscriptions.values())
    assert [(each["target_url"], each["is_enabled"]) for each in kept] == [(door, True) for door in doors]
    assert {each["event_type"] for each in kept} == {"submission.status.change"}
    assert prolific.secrets == [PlatformAccount.objects.get().hook_secret]


@pytest.mark.parametrize(("workspace", "door"), [("", "https://gtm.example/"), ("w1", "http://gtm.example/")])
def test_messages_that_could_not_come_are_not_asked_for(
    fresh: Campaign, prolific: Prolific, workspace: str, door: str
) -> None:
    with pytest.raises(studies.StudyError):
        studies.have_messages_sent(fresh, connect(fresh), workspace, door, None)
    assert prolific.asked == []


@pytest.mark.parametrize("address", ["https://gtm.example/join/x/", "https://gtm.example/join/x/?a=1"])
def test_a_pasted_link_gets_the_placeholders_for_who_comes(
    fresh: Campaign, prolific: Prolific, address: str
) -> None:
    sent = prolific.studies[draft(fresh, address=address).study]["external_study_url"]
    assert sent.startswith(address) and sent.count("?") == 1 and "SESSION_ID={{%SESSION_ID%}}" in sent
    assert studies.with_placeholders(Settings(), sent) == sent
