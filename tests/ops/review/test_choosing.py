"""How much of whose work is looked at by a person."""

from __future__ import annotations

from typing import Any

import pytest

from gtm_hit.models import Assignment, ReviewChoice
from gtm_hit.ops.review import choosing
from gtm_hit.ops.review.choosing import ToldSuspicion
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.transitions import transition
from tests.ops.review.scene import REASON, into_campaign, make_reviewer, make_work, state, submitted
from tests.work_scene import make_worker

pytestmark = pytest.mark.django_db


def chosen(work: Assignment) -> tuple[str, bool]:
    choice = ReviewChoice.objects.get(assignment=work)
    return choice.why, choice.chosen


def never_by_chance(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choosing, "chance", lambda _assignment: 0.999)


def test_without_a_campaign_everything_waits_for_a_person() -> None:
    work = submitted("alice", make_work())
    assert chosen(work) == ("all", True) and state(work) == "submitted"


def test_of_a_newcomer_everything_waits_until_he_is_trusted(monkeypatch: pytest.MonkeyPatch) -> None:
    never_by_chance(monkeypatch)
    dataset, alice, rita = make_work(frames=8), make_worker("alice"), make_reviewer()
    into_campaign(dataset, newcomer_batches=2, review_share=0.1)
    first, second = submitted(alice, dataset), submitted(alice, dataset)
    assert chosen(first) == chosen(second) == ("newcomer", True)
    for work in (first, second):
        transition(work, Action.ACCEPT, rita)
    third = submitted(alice, dataset)
    assert chosen(third) == ("trusted", False) and state(third) == "accepted"


def test_what_nobody_looks_at_is_accepted_by_the_system_on_record(monkeypatch: pytest.MonkeyPatch) -> None:
    never_by_chance(monkeypatch)
    dataset = make_work()
    into_campaign(dataset, newcomer_batches=0, review_share=0.1)
    last = submitted("alice", dataset).transitions.last()
    assert last and (last.action, last.user, last.worker) == ("accept_unseen", None, None)
    assert last.reason == "not chosen for review"


def test_after_a_rejection_trust_is_earned_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    never_by_chance(monkeypatch)
    dataset, alice, rita = make_work(frames=8), make_worker("alice"), make_reviewer()
    into_campaign(dataset, newcomer_batches=1, review_share=0.5)
    first, second = submitted(alice, dataset), submitted(alice, dataset)
    transition(first, Action.ACCEPT, rita)
    transition(second, Action.REJECT, rita, category="low_effort", reason=REASON)
    assert chosen(submitted(alice, dataset)) == ("newcomer", True)


def test_chance_takes_about_the_share_and_never_changes_its_mind() -> None:
    drawn = [choosing.chance(Assignment(pk=pk)) for pk in range(1, 4001)]
    assert drawn == [choosing.chance(Assignment(pk=pk)) for pk in range(1, 4001)]
    assert abs(sum(one < 0.1 for one in drawn) / 4000 - 0.1) < 0.02


def test_chance_cannot_be_foretold_without_the_server_s_key(settings: Any) -> None:
    before = [choosing.chance(Assignment(pk=pk)) for pk in range(1, 20)]
    settings.SECRET_KEY = "another" * 8
    assert before != [choosing.chance(Assignment(pk=pk)) for pk in range(1, 20)]


def test_the_suspicious_are_looked_at_with_the_reasons(monkeypatch: pytest.MonkeyPatch) -> None:
    never_by_chance(monkeypatch)
    dataset = make_work(frames=8)
    into_campaign(dataset, newcomer_batches=0, review_share=0.2)
    scores = {"alice": 0.3, "bob": 0.1, "carl": 0.9}
    monkeypatch.setattr(
        choosing, "SOURCES", [lambda one: ToldSuspicion(scores[one.worker.external_id], ("very fast",))]
    )
    works = {name: submitted(name, dataset) for name in scores}
    assert chosen(works["carl"]) == ("suspicion", True)
    assert chosen(works["bob"]) == ("trusted", False)
    assert ReviewChoice.objects.get(assignment=works["carl"]).reasons == ["very fast"]


def test_a_failing_score_stops_nobody_and_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    dataset = make_work()
    into_campaign(dataset, newcomer_batches=0, review_share=0.0)

    def fails(_assignment: Assignment) -> ToldSuspicion:
        raise RuntimeError("no score")

    monkeypatch.setattr(choosing, "SOURCES", [fails])
    work = submitted("alice", dataset)
    assert chosen(work) == ("unknown", True) and state(work) == "submitted"
