"""Gold, planted faults, scores and qualifications over REST, and by command."""

from __future__ import annotations

from io import StringIO
from typing import Any

import pytest
from django.core.management import CommandError, call_command

from gtm_hit.models import Campaign, GoldFrame, Layer, Planting, Qualification, Worker
from gtm_hit.ops.qualifications.requirements import missing_qualifications
from gtm_hit.ops.scores import computing
from gtm_hit.ops.work import assignments
from tests.api.conftest import Caller, bearer
from tests.gold_scene import confirm, hand_in, make_scene, plant_everywhere, take, truth_of_square
from tests.work_scene import make_worker

pytestmark = pytest.mark.django_db
DATASET = "/api/v1/datasets/square/"
CAMPAIGN = f"{DATASET}campaigns/street/"
NEW = {"name": "basics", "truth": "truth", "frames_per_try": 4}


@pytest.fixture
def scene() -> tuple[Campaign, Layer]:
    return make_scene()


@pytest.fixture
def script(scene: tuple[Campaign, Layer]) -> Caller:
    return bearer("read", "work")


@pytest.fixture
def alice(scene: tuple[Campaign, Layer]) -> Worker:
    return make_worker("alice")


def run(*arguments: str) -> str:
    out = StringIO()
    call_command(*arguments, stdout=out)
    return out.getvalue()


@pytest.mark.parametrize(
    "path", ["gold/", "planted-faults/", "required-qualifications/", "scores/", "suspicion/"]
)
def test_a_campaigns_quality_is_for_staff(scene: Any, stranger: Caller, user: Caller, path: str) -> None:
    assert stranger.get(CAMPAIGN + path).status_code == 401
    assert user.get(CAMPAIGN + path).status_code == 403
    assert bearer("read").get(CAMPAIGN + path).status_code == 200
    assert bearer("read").get(CAMPAIGN.replace("street", "road") + path).status_code == 404


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("campaigns/street/gold/", {"layer": "truth", "share": 0.5}),
        ("campaigns/street/planted-faults/", {"share": 0.5}),
        ("campaigns/street/required-qualifications/", {"names": []}),
        ("campaigns/street/scores/", {}),
        ("qualifications/", NEW),
    ],
)
def test_a_script_that_may_only_read_changes_nothing(scene: Any, path: str, body: dict[str, Any]) -> None:
    assert bearer("read").post(DATASET + path, body).status_code == 403
    for model in (GoldFrame, Planting, Qualification):
        assert not model.objects.exists()


def test_a_worker_gets_nothing_of_it(scene: Any) -> None:
    from tests.api.conftest import holder

    worker = holder(take(scene[0]))
    for path in ("gold/", "planted-faults/", "scores/", "suspicion/"):
        assert worker.get(CAMPAIGN + path).status_code == 401


def test_gold_frames_are_chosen(script: Caller) -> None:
    answer = script.post(f"{CAMPAIGN}gold/", {"layer": "truth", "share": 0.2}).json()
    assert answer["frames"] == len(answer["numbers"]) == 4
    assert script.get(f"{CAMPAIGN}gold/").json() == answer


@pytest.mark.parametrize("body", [{"layer": "nowhere", "share": 0.2}, {"layer": "truth", "share": 2}, {}])
def test_a_choice_that_cannot_be_is_refused(script: Caller, body: dict[str, Any]) -> None:
    assert script.post(f"{CAMPAIGN}gold/", body).status_code == 400
    assert not GoldFrame.objects.exists()


def test_faults_are_settled_told_and_stopped(script: Caller) -> None:
    wanted = {"starting_layer": "truth", "share": 0.5, "faults": 3, "kinds": ["swapped"], "seed": 4}
    answer = script.post(f"{CAMPAIGN}planted-faults/", wanted).json()
    assert answer["settings"] == wanted
    assert [one["kind"] for one in answer["results"]] == ["shifted", "removed", "swapped", "invented"]
    assert script.post(f"{CAMPAIGN}planted-faults/", {"share": 0.5, "kinds": ["odd"]}).status_code == 400
    assert Planting.objects.get().faults == 3
    client = script.client.delete(f"{CAMPAIGN}planted-faults/", headers=script.headers)
    assert client.json()["settings"] is None


def test_scores_and_suspicion_come_with_reasons(scene: tuple[Campaign, Layer], script: Caller) -> None:
    campaign, truth = scene
    plant_everywhere(campaign, truth)
    hand_in(take(campaign), truth_of_square())
    bad = take(campaign, "bob")
    confirm(bad)
    assignments.submit(bad)
    assert script.post(f"{CAMPAIGN}scores/").json() == {"assignments": 2}
    workers = script.get(f"{CAMPAIGN}scores/").json()["results"]
    assert workers[0]["worker"] == bad.worker.pseudonym
    assert "0 of 3 planted faults repaired." in workers[0]["why"]
    first = script.get(f"{CAMPAIGN}suspicion/").json()["results"][0]
    assert (first["id"], first["suspicion"] > 0.8) == (bad.pk, True)


def test_a_qualification_is_made_granted_revoked_and_asked_for(
    scene: tuple[Campaign, Layer], script: Caller, alice: Worker
) -> None:
    made = script.post(f"{DATASET}qualifications/", {**NEW, "min_recall": 0.8})
    assert (made.status_code, made.json()["min_recall"], made.json()["tried"]) == (201, 0.8, 0)
    assert script.post(f"{CAMPAIGN}required-qualifications/", {"names": ["basics"]}).json() == {
        "names": ["basics"]
    }
    grants = f"{DATASET}qualifications/basics/grants/"
    granted = script.post(grants, {"worker": alice.pseudonym, "granted": True, "why": "known"}).json()
    assert (granted["granted"], granted["by"], granted["why"]) == (True, "script", "known")
    assert missing_qualifications(scene[0], alice) == []
    assert script.post(grants, {"worker": alice.pseudonym, "granted": False}).status_code == 400
    assert (
        script.post(grants, {"worker": alice.pseudonym, "granted": False, "why": "shared"}).status_code == 200
    )
    assert missing_qualifications(scene[0], alice) == ["basics"]
    assert script.get(grants).json()["results"][0]["granted"] is False
    assert script.get(f"{DATASET}qualifications/basics/tries/").json()["results"] == []


def test_what_is_not_there_is_said(script: Caller) -> None:
    assert script.post(f"{DATASET}qualifications/", {**NEW, "truth": "nowhere"}).status_code == 400
    assert script.post(f"{CAMPAIGN}required-qualifications/", {"names": ["none"]}).status_code == 400
    assert script.get(f"{DATASET}qualifications/none/grants/").status_code == 404
    script.post(f"{DATASET}qualifications/", NEW)
    body = {"worker": "w-0", "granted": True}
    assert script.post(f"{DATASET}qualifications/basics/grants/", body).status_code == 400


def test_the_commands_do_the_same(scene: tuple[Campaign, Layer], alice: Worker) -> None:
    campaign, _truth = scene
    assert "4 gold frames" in run("goldframes", "square", "street", "--layer", "truth", "--share", "0.2")
    told = run("plantedfaults", "square", "street", "--share", "1", "--start", "truth", "--kinds", "shifted")
    assert "shifted: 0 planted" in told
    assert Planting.objects.get().kinds == ["shifted"]
    done = hand_in(take(campaign), truth_of_square())
    assert "shifted: 2 planted, 2 submitted, 2 repaired" in run("plantedfaults", "square", "street")
    assert f"{done.worker.pseudonym}: " in run("scores", "square", "street", "--recompute")
    assert "batch 1/1" in run("scores", "square", "street", "--suspicion")
    run("plantedfaults", "square", "street", "--stop")
    assert not Planting.objects.exists()


def test_the_command_for_qualifications(scene: tuple[Campaign, Layer], alice: Worker) -> None:
    campaign, _truth = scene
    made = run("qualification", "square", "basics", "--truth", "truth", "--frames-per-try", "4")
    assert "basics: open, 0 tried" in made
    run("qualification", "square", "basics", "--require", "street")
    assert missing_qualifications(campaign, alice) == ["basics"]
    run("qualification", "square", "basics", "--grant", alice.pseudonym)
    assert missing_qualifications(campaign, alice) == []
    with pytest.raises(CommandError, match="Say why"):
        run("qualification", "square", "basics", "--revoke", alice.pseudonym)
    assert "closed" in run("qualification", "square", "basics", "--close")
    run("qualification", "square", "--require", "street")
    assert not campaign.required_qualifications.exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ("goldframes", "square", "road"),
        ("goldframes", "square", "street", "--layer", "truth", "--share", "3"),
        ("plantedfaults", "square", "street", "--share", "1", "--kinds", "odd"),
        ("qualification", "square", "none", "--close"),
        ("qualification", "nowhere"),
        ("scores", "square", "road"),
    ],
)
def test_commands_say_what_is_wrong(scene: Any, arguments: tuple[str, ...]) -> None:
    with pytest.raises(CommandError):
        run(*arguments)


def test_a_large_campaign_is_left_to_the_night(
    scene: tuple[Campaign, Layer], script: Caller, monkeypatch: pytest.MonkeyPatch
) -> None:
    from gtm_hit.ops.scores import listing

    hand_in(take(scene[0]), truth_of_square())
    monkeypatch.setattr(listing, "MOST_AT_ONCE", 0)
    assert script.post(f"{CAMPAIGN}scores/").status_code == 409
    assert not computing.evidence_of(scene[0])
