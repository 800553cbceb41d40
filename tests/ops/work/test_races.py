"""Real processes, real databases. Each race runs once per database; the tests look at what came out."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from tests.services import postgres_url  # noqa: F401

REPOSITORY = Path(__file__).resolve().parents[3]
Races = dict[str, list[Any]]


@pytest.fixture(
    scope="module",
    params=[
        pytest.param("sqlite", marks=pytest.mark.xdist_group("races-sqlite")),
        pytest.param("postgres", marks=[pytest.mark.services, pytest.mark.xdist_group("races-postgres")]),
    ],
)
def races(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Races:
    folder = tmp_path_factory.mktemp("races")
    if request.param == "sqlite":
        url = f"sqlite:///{folder}/races.sqlite3"
    else:
        url = request.getfixturevalue("postgres_url")
    environment = {
        **os.environ,
        "DJANGO_SETTINGS_MODULE": "tests.settings",
        "DATABASE_URL": url,
        "DATA_DIR": str(folder),
    }
    command = [sys.executable, "-m", "tests.ops.races"]
    output = subprocess.run(
        command, cwd=REPOSITORY, env=environment, stdout=subprocess.PIPE, check=True, timeout=300
    ).stdout
    return json.loads(output)


def test_fifty_workers_never_share_a_batch(races: Races) -> None:
    got = [answer for answer in races["claiming"] if isinstance(answer, int)]
    assert len(got) == len(set(got)) == 40
    assert races["claiming"].count("NoFreeBatch") == 10


def test_fifty_workers_never_share_a_copy(races: Races) -> None:
    assert len(set(races["claiming_copies"])) == 50


def test_one_worker_in_twenty_tabs_gets_one_batch(races: Races) -> None:
    assert len(races["one_worker"]) == 20
    assert len(set(races["one_worker"])) == 1
    assert isinstance(races["one_worker"][0], int)


def test_one_worker_in_twenty_tabs_gets_two_batches_where_two_are_allowed(races: Races) -> None:
    assert len(races["one_worker_of_two"]) == 20
    assert len(set(races["one_worker_of_two"])) == 2
    assert all(isinstance(answer, int) for answer in races["one_worker_of_two"])


def test_an_expired_batch_goes_to_one_worker_only(races: Races) -> None:
    got = Counter(races["expired_batch"])
    assert got.pop("NoFreeBatch") == 19
    assert list(got.values()) == [1]


def test_one_id_arriving_twenty_times_is_one_worker(races: Races) -> None:
    assert len(set(races["arriving"])) == 1
    assert isinstance(races["arriving"][0], int)


def test_batches_made_by_ten_at_once_are_made_once(races: Races) -> None:
    assert sorted(races["making_batches"]) == [0] * 9 + [20]


def test_one_save_sent_twenty_times_is_written_once(races: Races) -> None:
    assert races["repeated_save"] == [1] * 20


def test_of_competing_saves_one_wins_and_the_others_are_told(races: Races) -> None:
    assert Counter(races["competing_saves"]) == {1: 1, "StaleSave": 19}


def test_a_save_id_is_accepted_for_one_frame(races: Races) -> None:
    got = Counter(races["shared_save_id"])
    assert got.pop("SaveIdUsed") == 9
    assert list(got.values()) == [1]


def test_a_batch_submitted_ten_times_has_one_code(races: Races) -> None:
    assert len(set(races["submitting"])) == 1
    assert len(races["submitting"][0]) == 20


def test_of_ten_reviewers_one_decides_and_the_others_are_told(races: Races) -> None:
    got = Counter(races["deciding"])
    assert got.pop("WrongState") == 9
    assert list(got.values()) == [1] and set(got) <= {"accepted", "rejected"}


def test_a_batch_whose_rejection_is_overturned_is_held_by_one_still(races: Races) -> None:
    got = Counter(races["overturning"])
    assert got.pop("accepted") == 1
    assert got["NoFreeBatch"] >= 9 and sum(got.values()) == 10


def test_the_history_reads_the_same_on_every_database(races: Races) -> None:
    keys = ["person", "position", "state", "origin", "height", "radius"]
    assert [keys, keys] in races["looking_back"]
    assert [2, 0] in races["looking_back"]


def test_no_save_slips_in_after_the_submission(races: Races) -> None:
    assert "submitted" in races["saving_and_submitting"]
    assert set(races["saving_and_submitting"]) <= {"submitted", 2, "ReadOnly"}
