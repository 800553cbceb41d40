"""pay, outbox and prolific: the same operations on the command line."""

from __future__ import annotations

import re
from io import StringIO
from pathlib import Path

import pytest
from django.contrib.auth.models import User
from django.core.management import CommandError, call_command

from gtm_hit.models import Assignment, Campaign, MoneyEntry, OutboxRow, PlatformAccount, Worker
from gtm_hit.ops.access.roles import Role
from tests.campaign_scene import account
from tests.paid_campaign import accepted_work, assign, prolific_campaign
from tests.prolific_server import TOKEN, Prolific
from tests.work_scene import make_dataset, make_worker

NAMES = ("square", "autumn")


@pytest.fixture
def ada(db: None, prolific: Prolific) -> Worker:
    return accepted_work(prolific_campaign(title="T", instructions="I"))


def run(command: str, *arguments: str) -> str:
    output = StringIO()
    call_command(command, *NAMES, *arguments, stdout=output, stderr=StringIO())
    return output.getvalue()


def test_pay_prints_who_is_to_get_what(ada: Worker) -> None:
    text = run("pay")
    assert ada.pseudonym in text and "cost 2.00" in text and "forecast 24.00" in text


def test_pay_approves_pays_takes_back_and_writes_csv(ada: Worker, tmp_path: Path) -> None:
    account("vera", Role.MANAGER, Campaign.objects.get().dataset)
    run("pay", "--as", "vera", "--approve-bonuses")
    run("pay", "--paid", ada.pseudonym, "--amount", "1.50", "--note", "cash")
    line = MoneyEntry.objects.get(kind="paid")
    run("pay", "--take-back", str(line.pk), "--note", "came back", "--csv", str(tmp_path))
    assert "taken" not in (tmp_path / "ledger.csv").read_text()
    assert len((tmp_path / "ledger.csv").read_text().splitlines()) == 6
    assert MoneyEntry.objects.get(kind="bonus_approved").user == User.objects.get()


@pytest.mark.parametrize(
    "arguments",
    [
        ["--paid", "nobody"],
        ["--bonus", "nobody", "1"],
        ["--as", "nobody"],
        ["--take-back", "99"],
    ],
)
def test_pay_refuses_what_it_does_not_know(ada: Worker, arguments: list[str]) -> None:
    with pytest.raises(CommandError):
        run("pay", *arguments)
    assert not MoneyEntry.objects.exists()


def test_a_worker_of_another_campaign_is_nobody_in_this_one(ada: Worker) -> None:
    with pytest.raises(CommandError, match="in this campaign"):
        run("pay", "--paid", make_worker("bob", "link").pseudonym)


def test_an_unknown_campaign_is_told_with_those_there_are(ada: Worker) -> None:
    with pytest.raises(CommandError, match="autumn"):
        call_command("pay", "square", "winter")


def test_outbox_tells_dry_plans_and_sends(ada: Worker, prolific: Prolific) -> None:
    run("pay", "--approve-bonuses")
    assert "would plan: 2 rows, 4.00 EUR" in run("outbox", "--plan-payouts", "--dry-run")
    assert not OutboxRow.objects.exists()
    run("outbox", "--plan-payouts")
    assert "1 × approve, 2.00 EUR" in run("outbox", "--send", "--dry-run")
    assert prolific.asked == []
    assert "confirmed 3, failed 0, unclear 0" in run("outbox", "--send")
    assert prolific.paid("s1") == 2


def test_outbox_asks_for_a_submission_back(ada: Worker) -> None:
    assign(Campaign.objects.get(), ada, Assignment.State.SUBMITTED, submission="s2")
    with pytest.raises(CommandError, match="Say why"):
        run("outbox", "--ask-back", "s2")
    assert "request_return" in run("outbox", "--ask-back", "s2", "--reason", "Only one view was looked at")


def test_outbox_goes_by_files(ada: Worker, tmp_path: Path) -> None:
    run("outbox", "--plan-payouts")
    assert run("outbox", "--file", "approvals") == "s1\n"
    row = OutboxRow.objects.get()
    with pytest.raises(CommandError, match="--upto"):
        run("outbox", "--done", "approvals")
    assert "1 rows are done" in run("outbox", "--done", "approvals", "--upto", str(row.pk))
    listed = tmp_path / "list.csv"
    listed.write_text("Submission id,Status\ns1,APPROVED\n")
    assert "1 submissions read, 1" in run("outbox", "--submissions", str(listed))
    with pytest.raises(CommandError):
        run("outbox", "--submissions", str(tmp_path / "missing.csv"))


def test_outbox_decides_about_rows(ada: Worker) -> None:
    run("outbox", "--plan-payouts")
    row = OutboxRow.objects.get()
    with pytest.raises(CommandError):
        run("outbox", "--retry", str(row.pk))
    assert "withdrawn" in run("outbox", "--withdraw", str(row.pk))


def test_prolific_drafts_and_publishes_and_tells_no_key(
    ada: Worker, prolific: Prolific, tmp_path: Path
) -> None:
    PlatformAccount.objects.update(study="", token="")
    (tmp_path / "key").write_text(f"{TOKEN}\n")
    told = run("prolific", "--key-file", str(tmp_path / "key"))
    assert "there is one" in told and TOKEN not in told
    assert "unpublished" in run("prolific", "--draft", "https://gtm.example/join/x/", "--places", "3")
    assert re.search(r"study: \w+ active", run("prolific", "--publish"))
    assert "active" in run("prolific", "--look")
    with pytest.raises(CommandError, match="already"):
        run("prolific", "--publish")


def test_prolific_refuses_an_empty_key_and_a_strange_address(ada: Worker, tmp_path: Path) -> None:
    (tmp_path / "key").write_text("\n")
    for arguments in (["--key-file", str(tmp_path / "key")], ["--address", "http://10.0.0.1"]):
        with pytest.raises(CommandError):
            run("prolific", *arguments)
    assert PlatformAccount.objects.get().token == TOKEN


@pytest.mark.parametrize("command", ["pay", "outbox", "prolific"])
def test_only_a_manager_of_the_dataset_lends_his_name(ada: Worker, command: str) -> None:
    dataset = Campaign.objects.get().dataset
    account("rita", Role.REVIEWER, dataset)
    account("elsewhere", Role.MANAGER, make_dataset("other"))
    account("vera", Role.MANAGER, dataset)
    for name in ("rita", "elsewhere"):
        with pytest.raises(CommandError, match="takes the role"):
            run(command, "--as", name)
    assert run(command, "--as", "vera") == run(command)
