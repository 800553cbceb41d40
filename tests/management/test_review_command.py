"""The review command: what a script sees and decides."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from typing import Any

import pytest
from django.core.management import CommandError, call_command
from django.db import connection

from gtm_hit.models import Assignment, Transition
from gtm_hit.ops.access.roles import Role
from tests.campaign_scene import account
from tests.conftest import REPOSITORY
from tests.ops.review.scene import REASON, make_reviewer, make_work, state, submitted
from tests.work_scene import make_dataset

pytestmark = pytest.mark.django_db


@pytest.fixture
def work() -> Assignment:
    make_reviewer()
    return submitted("alice", make_work())


def run(*arguments: str) -> str:
    output = io.StringIO()
    call_command("review", "square", *arguments, stdout=output)
    return output.getvalue()


def told(*arguments: str) -> Any:
    return json.loads(run(*arguments, "--json"))


def test_the_list_is_one_object(work: Assignment) -> None:
    assert [one["id"] for one in told()["waiting"]] == [work.pk]
    assert told("--list", "decided") == {"decided": []}
    assert f"id {work.pk}" in run()


def test_a_decision_names_who_takes_it(work: Assignment) -> None:
    with pytest.raises(CommandError, match="--by"):
        run("accept", str(work.pk))
    with pytest.raises(CommandError, match="nobody"):
        run("accept", str(work.pk), "--by", "nobody")
    assert told("accept", str(work.pk), "--by", "rita")["state"] == "accepted"


def test_comment_return_and_reject_say_the_same_as_elsewhere(work: Assignment) -> None:
    by = ("--by", "rita")
    said = told("comment", str(work.pk), "--frame", "5", "--person", "1", "--reason", "Too far left", *by)
    assert said["comments"][0]["frame"] == 5
    with pytest.raises(CommandError, match="categories"):
        run("reject", str(work.pk), "--reason", REASON, *by)
    assert told("return", str(work.pk), *by)["state"] == "returned"
    assert "Too far left" in run("show", str(work.pk))


def test_what_is_refused_changes_nothing(work: Assignment) -> None:
    with pytest.raises(CommandError):
        run("uphold", str(work.pk), "--by", "rita", "--reason", "No")
    with pytest.raises(CommandError, match="no assignment 99"):
        run("accept", "99", "--by", "rita")
    assert state(work) == "submitted" and Transition.objects.count() == 1


@pytest.mark.django_db(transaction=True)
def test_as_a_process_it_prints_one_object_and_fails_with_words(work: Assignment) -> None:
    def process(*arguments: str) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, "DATABASE_URL": f"sqlite:///{connection.settings_dict['NAME']}"}
        command = [sys.executable, "manage.py", "review", "square", *arguments]
        environment["DJANGO_SETTINGS_MODULE"] = "tests.settings"
        return subprocess.run(command, cwd=REPOSITORY, env=environment, capture_output=True, text=True)

    refused = process("reject", str(work.pk), "--by", "rita", "--json")
    assert refused.returncode == 1 and "categories" in refused.stderr and not refused.stdout
    accepted = process("accept", str(work.pk), "--by", "rita", "--json")
    assert json.loads(accepted.stdout)["state"] == state(work) == "accepted"


def test_who_is_no_reviewer_of_the_dataset_may_not_lend_his_name(work: Assignment) -> None:
    account("max", Role.MAINTAINER, work.batch.dataset)
    account("elsewhere", Role.REVIEWER, make_dataset("other"))
    for name in ("max", "elsewhere"):
        for arguments in (("accept",), ("mend",), ("comment", "--reason", "Well")):
            with pytest.raises(CommandError, match="takes the role"):
                run(arguments[0], str(work.pk), *arguments[1:], "--by", name)
    assert state(work) == "submitted"
