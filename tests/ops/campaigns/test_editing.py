"""What a campaign may be, and what of it may still change."""

from __future__ import annotations

from decimal import Decimal
from itertools import pairwise
from typing import Any

import pytest

from gtm_hit.models import Batch, Campaign
from gtm_hit.ops.campaigns import changes, cutting, editing, states
from gtm_hit.ops.campaigns.errors import CampaignError
from tests.campaign_scene import make_campaign, make_draft
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db


def frames(batch: Batch) -> list[int]:
    return list(batch.frames.order_by("number").values_list("number", flat=True))


@pytest.mark.parametrize("count", [1, 9, 10, 11, 19, 20, 28, 37, 100])
@pytest.mark.parametrize(("size", "overlap"), [(10, 1), (10, 0), (10, 4), (1, 0), (3, 2)])
def test_runs_cover_every_frame_and_share_the_overlap(count: int, size: int, overlap: int) -> None:
    found = cutting.runs(range(count), size, overlap)
    assert {frame for run in found for frame in run} == set(range(count))
    assert len(found) == cutting.batch_count(count, size, overlap)
    for before, after in pairwise(found):
        assert before[len(before) - overlap :] == after[:overlap]
        assert set(after) - set(before)


def test_opening_cuts_batches_that_share_a_frame() -> None:
    campaign = make_campaign(make_dataset(frames=19), copies=2)
    rows = list(campaign.batches.order_by("number", "copy"))
    assert [(row.number, row.copy) for row in rows] == [(1, 1), (1, 2), (2, 1), (2, 2)]
    assert frames(rows[0]) == frames(rows[1])
    assert frames(rows[0])[-1] == frames(rows[2])[0] == 45


def test_opening_again_after_a_pause_cuts_nothing_new() -> None:
    campaign = make_campaign()
    before = set(campaign.batches.values_list("pk", flat=True))
    states.take(states.take(campaign, "pause"), "open")
    assert set(campaign.batches.values_list("pk", flat=True)) == before


def test_more_copies_of_an_open_campaign_are_there_at_once() -> None:
    campaign = editing.edit(make_campaign(), {"copies": 3})
    for number in (1, 2, 3):
        copies = campaign.batches.filter(number=number)
        assert copies.count() == 3
        assert len({tuple(frames(copy)) for copy in copies}) == 1


OTHER: dict[str, Any] = {
    "name": "other",
    "title": "Marking people",
    "instructions": "All of them.",
    "platform": "own_team",
    "platform_settings": {"fixed_code": "ABC"},
    "entry": "invited",
    "batch_size": 12,
    "overlap": 2,
    "copies": 2,
    "lease_minutes": 30,
    "batches_per_worker": 4,
    "batches_at_once": 2,
    "expected_minutes": 20,
    "currency": "EUR",
    "pay_per_batch": Decimal("3.00"),
    "hourly_floor": Decimal("9.00"),
    "review_share": 0.5,
    "newcomer_batches": 5,
}


def test_the_table_names_every_field() -> None:
    assert set(OTHER) == set(changes.WHILE_OPEN) == set(changes.LABELS)


@pytest.mark.parametrize("field", OTHER)
def test_everything_of_a_draft_may_change(field: str) -> None:
    campaign = editing.edit(make_draft(), {field: OTHER[field]})
    assert getattr(campaign, field) == OTHER[field]


@pytest.mark.parametrize("field", OTHER)
@pytest.mark.parametrize("step", ["open", "pause"])
def test_an_open_campaign_changes_only_what_the_table_allows(field: str, step: str) -> None:
    campaign = make_campaign()
    if step == "pause":
        campaign = states.take(campaign, "pause")
    before = getattr(campaign, field)
    if changes.WHILE_OPEN[field].fixed:
        with pytest.raises(CampaignError) as error:
            editing.edit(campaign, {field: OTHER[field]})
        assert error.value.field == field
        assert getattr(Campaign.objects.get(), field) == before
    else:
        assert getattr(editing.edit(campaign, {field: OTHER[field]}), field) == OTHER[field]


@pytest.mark.parametrize("field", OTHER)
def test_nothing_of_a_closed_campaign_changes(field: str) -> None:
    campaign = states.take(make_campaign(), "close")
    with pytest.raises(CampaignError):
        editing.edit(campaign, {field: OTHER[field]})
    assert getattr(Campaign.objects.get(), field) == getattr(campaign, field)


@pytest.mark.parametrize(
    ("field", "less"), [("copies", 1), ("pay_per_batch", Decimal("1.99")), ("hourly_floor", Decimal("4"))]
)
def test_what_was_promised_does_not_shrink(field: str, less: Any) -> None:
    campaign = make_campaign(copies=2, pay_per_batch=Decimal("2.00"), hourly_floor=Decimal("5"))
    with pytest.raises(CampaignError) as error:
        editing.edit(campaign, {field: less, "title": "new"})
    assert error.value.field == field
    assert Campaign.objects.get().title == ""


@pytest.mark.parametrize(
    "values",
    [
        {"name": ""},
        {"name": "a b"},
        {"name": "new"},
        {"name": "x" * 61},
        {"overlap": 10},
        {"batch_size": 0},
        {"batch_size": 501},
        {"copies": 21},
        {"currency": "eur"},
        {"pay_per_batch": Decimal("-1")},
        {"review_share": 1.5},
        {"platform": "mturk"},
        {"entry": "nobody"},
        {"colour": "red"},
        {"lease_minutes": 0},
    ],
)
def test_a_campaign_that_makes_no_sense_is_refused(values: dict[str, Any]) -> None:
    dataset = make_dataset()
    with pytest.raises(CampaignError):
        editing.create(dataset, {"name": "walk", **values})
    assert not Campaign.objects.exists()


def test_a_name_is_there_once_in_a_dataset() -> None:
    dataset = make_dataset()
    make_draft(dataset)
    with pytest.raises(CampaignError, match="already"):
        make_draft(dataset)
    assert make_draft(make_dataset("other"))


SETTINGS: list[tuple[str, dict[str, Any]]] = [
    ("link", {"worker_parameter": "a b"}),
    ("link", {"fixed_code": "x y"}),
    ("link", {"return_address": "javascript:alert(1)"}),
    ("link", {"return_address": "http://panel.example/"}),
    ("link", {"return_address": "https://user:word@panel.example/"}),
    ("link", {"submit_to": []}),
    ("own_team", {"anything": 1}),
    ("prolific", {"code_completed": "'"}),
    ("prolific", {"worker_parameter": 3}),
    ("external_question", {"submit_to": ["https://elsewhere.example"]}),
    ("external_question", {"frame_ancestors": "https://panel.example"}),
    ("external_question", {"frame_ancestors": ["https://panel.example/path"]}),
    ("external_question", {"frame_ancestors": ["https://panel.example; script-src *"]}),
    ("external_question", {"frame_ancestors": ["*"]}),
]


@pytest.mark.parametrize(("platform", "given"), SETTINGS)
def test_a_wrong_setting_of_a_platform_is_refused(
    platform: str, given: dict[str, Any], settings: Any
) -> None:
    settings.EMBEDDING_ORIGINS = ["https://panel.example", "*"]
    with pytest.raises(CampaignError) as error:
        make_draft(platform=platform, platform_settings=given)
    assert error.value.field == "platform_settings"
    assert not Campaign.objects.exists()


@pytest.mark.parametrize("platform", ["prolific", "external_question"])
def test_a_campaign_whose_platform_lacks_a_setting_does_not_open(platform: str) -> None:
    campaign = make_draft(platform=platform, platform_settings={})
    with pytest.raises(CampaignError):
        states.take(campaign, "open")
    assert Campaign.objects.get().state == "draft"
    assert not Batch.objects.exists()


STATES = {"draft": [], "open": ["open"], "paused": ["open", "pause"], "closed": ["close"]}
ALLOWED = {
    ("draft", "open"): "open",
    ("draft", "close"): "closed",
    ("open", "open"): "open",
    ("open", "pause"): "paused",
    ("open", "close"): "closed",
    ("paused", "open"): "open",
    ("paused", "pause"): "paused",
    ("paused", "close"): "closed",
    ("closed", "close"): "closed",
}


@pytest.mark.parametrize("step", states.STEPS)
@pytest.mark.parametrize("state", STATES)
def test_a_campaign_goes_from_state_to_state_or_says_why_not(state: str, step: str) -> None:
    campaign = make_draft()
    for before in STATES[state]:
        campaign = states.take(campaign, before)
    if (state, step) in ALLOWED:
        assert states.take(campaign, step).state == ALLOWED[state, step]
    else:
        with pytest.raises(CampaignError):
            states.take(campaign, step)
        assert Campaign.objects.get().state == state


def test_a_dataset_without_frames_opens_no_campaign() -> None:
    campaign = make_draft(make_dataset(frames=0))
    with pytest.raises(CampaignError, match="no frames"):
        states.take(campaign, "open")
