"""Stitching by REST: who may, what is refused, what is remembered."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gtm_hit.models import Campaign, Dataset, Job, Layer, StitchConflict
from gtm_hit.ops.jobs.progress import no_progress
from gtm_hit.ops.stitching.running import Asked, stitch_layer
from gtm_hit.ops.stitching.scope import Scope
from tests.api.conftest import Caller, bearer
from tests.stitch_scene import doubtful, two_batches
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db

BASE = "/api/v1/datasets/square/stitching/"


@pytest.fixture(autouse=True)
def own_storage(settings: Any, tmp_path: Path) -> None:
    settings.TABLES_ROOT = tmp_path / "tables"


@pytest.fixture
def asked() -> StitchConflict:
    dataset = doubtful()
    stitch_layer(Scope(dataset), Asked(), None, no_progress)
    return StitchConflict.objects.get()


def test_a_script_starts_it_and_reads_how_far_it_is() -> None:
    two_batches()
    answer = bearer("work").post(BASE, {"gap": 3})
    assert (answer.status_code, answer.json()["kind"]) == (202, "stitch")
    assert Job.objects.get().parameters["gap"] == 3
    shown = bearer("read").get(BASE).json()
    assert (shown["accepted"], shown["covered"], shown["layer"]) == (2, 20, None)


def test_both_sides_are_shown_on_the_ground_and_in_the_views_that_see_them(asked: StitchConflict) -> None:
    shown = bearer("read").get(f"{BASE}conflicts/{asked.pk}/").json()
    assert [place["frame"] for place in shown["before"]] == [5 * index for index in range(10)]
    assert shown["after"][0]["frame"] == 50
    pictures = shown["pictures"][0]
    assert {box["side"] for picture in pictures for box in picture["boxes"]} == {"before", "after"}
    assert len(pictures[0]["light"]) == 64


@pytest.mark.parametrize("side", ["before", "after"])
def test_a_side_made_of_nothing_that_is_still_there_is_shown_as_empty(
    asked: StitchConflict, side: str
) -> None:
    for sources in ([], [[10**9, 1]]):
        StitchConflict.objects.filter(pk=asked.pk).update(**{side: sources})
        answer = bearer("read").get(f"{BASE}conflicts/{asked.pk}/")
        assert (answer.status_code, answer.json()[side]) == (200, [])


def test_a_decision_is_kept_and_taken_back(asked: StitchConflict) -> None:
    script = bearer("work")
    answer = script.post(f"{BASE}conflicts/{asked.pk}/decide/", {"decision": "same"})
    assert (answer.status_code, answer.json()["decided_by"]) == (200, "script")
    found = bearer("read").get(f"{BASE}conflicts/?state=decided").json()
    assert [row["id"] for row in found["results"]] == [asked.pk]
    assert script.post(f"{BASE}conflicts/{asked.pk}/undo/").json()["state"] == "open"
    again = script.post(f"{BASE}conflicts/{asked.pk}/undo/")
    assert (again.status_code, again.json()["code"]) == (409, "not_as_it_was")


def test_somebody_elses_other_decision_is_not_overwritten(asked: StitchConflict) -> None:
    script = bearer("work")
    script.post(f"{BASE}conflicts/{asked.pk}/decide/", {"decision": "apart"})
    answer = script.post(f"{BASE}conflicts/{asked.pk}/decide/", {"decision": "same"})
    assert answer.status_code == 409
    asked.refresh_from_db()
    assert asked.decision == "apart"


@pytest.mark.parametrize(
    "body", [{"gate": 0}, {"gap": -1}, {"margin": "much"}, {"campaign": "nobody-s"}, {"gate": 1e400}]
)
def test_what_makes_no_sense_is_refused_and_starts_nothing(body: dict[str, Any]) -> None:
    two_batches()
    assert bearer("work").post(BASE, body).status_code == 400
    assert not Job.objects.exists()


def test_nothing_accepted_is_refused_with_the_reason() -> None:
    make_dataset()
    answer = bearer("work").post(BASE)
    assert answer.status_code == 400 and "accepted" in str(answer.json())


def test_a_conflict_of_another_dataset_is_not_found(asked: StitchConflict) -> None:
    make_dataset("other")
    assert bearer("read").get(f"/api/v1/datasets/other/stitching/conflicts/{asked.pk}/").status_code == 404


def test_a_campaigns_conflicts_are_its_own(asked: StitchConflict) -> None:
    Campaign.objects.create(dataset=Dataset.objects.get(), name="autumn")
    found = bearer("read").get(f"{BASE}conflicts/?campaign=autumn").json()
    assert found["results"] == []


@pytest.mark.parametrize("path", ["", "conflicts/1/decide/", "conflicts/1/undo/"])
def test_strangers_and_keys_that_only_read_change_nothing(path: str, asked: StitchConflict) -> None:
    path = path.replace("1", str(asked.pk))
    assert Caller().post(BASE + path, {"decision": "same"}).status_code == 401
    assert bearer("read").post(BASE + path, {"decision": "same"}).status_code == 403
    asked.refresh_from_db()
    assert asked.state == "open"
    assert Layer.objects.filter(kind=Layer.Kind.GROUND_TRUTH).count() == 1


@pytest.mark.parametrize("path", ["", "conflicts/", "conflicts/1/"])
def test_strangers_see_nothing(path: str, asked: StitchConflict) -> None:
    assert Caller().get(BASE + path.replace("1", str(asked.pk))).status_code == 401
