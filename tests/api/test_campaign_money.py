"""Pay, outbox and platform by REST: who may, what it does, and what it refuses."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

import pytest

from gtm_hit.models import Assignment, Campaign, Job, MoneyEntry, OutboxRow, PlatformAccount, Worker
from gtm_hit.ops.outbox import rows
from gtm_hit.ops.pay import ledger
from tests.api.conftest import Caller, bearer
from tests.paid_campaign import accepted_work, assign, prolific_campaign
from tests.prolific_server import Prolific

PLACE = "/api/v1/datasets/square/campaigns/autumn/"
GETS = [
    "pay/",
    "pay/ledger/",
    "pay/workers.csv",
    "pay/ledger.csv",
    "outbox/",
    "outbox/files/bonuses.csv",
    "platform/",
]
POSTS: dict[str, dict[str, Any]] = {
    "pay/bonuses/": {},
    "pay/payments/": {"worker": "ada"},
    "pay/ledger/1/take-back/": {"note": "why"},
    "outbox/payouts/": {"dry_run": False},
    "outbox/send/": {},
    "outbox/1/": {"action": "retry"},
    "outbox/files/bonuses/done/": {"upto": 99},
    "outbox/submissions/": {"csv": "Submission id,Status\ns1,RETURNED\n"},
    "platform/": {"study": "st2"},
    "platform/draft/": {},
    "platform/study/": {"action": "publish"},
    "platform/messages/": {"workspace": "w1"},
}


@pytest.fixture
def campaign(db: None, prolific: Prolific) -> Campaign:
    return prolific_campaign()


@pytest.fixture
def ada(campaign: Campaign) -> Worker:
    return accepted_work(campaign)


def traces() -> tuple[int, ...]:
    return MoneyEntry.objects.count(), OutboxRow.objects.count(), Job.objects.count()


@pytest.mark.parametrize("address", [*GETS, *POSTS])
def test_strangers_accounts_and_keys_for_other_things_are_turned_away(
    ada: Worker, stranger: Caller, user: Caller, address: str
) -> None:
    for caller, status in ((stranger, 401), (user, 403), (bearer("import"), 403)):
        how = caller.post if address in POSTS else caller.get
        answer = how(PLACE + address, POSTS[address]) if address in POSTS else how(PLACE + address)
        assert answer.status_code == status, address
    assert traces() == (0, 0, 0)


@pytest.mark.parametrize("address", GETS)
def test_a_key_that_reads_reads(ada: Worker, address: str) -> None:
    assert bearer("read").get(PLACE + address).status_code == 200


@pytest.mark.parametrize("address", [*GETS, *POSTS])
def test_a_campaign_that_is_not_there_is_not_found(staff: Caller, ada: Worker, address: str) -> None:
    place = PLACE.replace("autumn", "winter") + address
    answer = staff.post(place, POSTS[address]) if address in POSTS else staff.get(place)
    assert answer.status_code == 404


def test_pay_tells_who_is_to_get_what(staff: Caller, ada: Worker) -> None:
    told = staff.get(f"{PLACE}pay/").json()
    (line,) = told["workers"]
    assert (told["currency"], told["totals"]["forecast"]) == ("EUR", "24.00")
    assert (line["worker"], line["per_hour"], line["bonus_proposed"], line["to_pay"]) == (
        ada.pseudonym,
        "4.00",
        "2.00",
        "2.00",
    )


def test_bonuses_are_approved_and_payments_marked(staff: Caller, ada: Worker) -> None:
    (bonus,) = staff.post(f"{PLACE}pay/bonuses/", {"workers": [ada.pseudonym]}).json()
    assert (bonus["kind"], bonus["amount"], bonus["by"]) == ("bonus_approved", "2.00", "manager")
    paid = staff.post(f"{PLACE}pay/payments/", {"worker": ada.pseudonym, "amount": "1.50", "note": "cash"})
    assert (paid.json()["kind"], paid.json()["note"]) == ("paid", "cash")
    again = staff.post(f"{PLACE}pay/payments/", {"worker": ada.pseudonym, "amount": "2.51"})
    assert (again.status_code, again.json()["code"]) == (409, "conflict")
    assert staff.get(f"{PLACE}pay/ledger/").json()["count"] == 4
    back = staff.post(f"{PLACE}pay/ledger/{paid.json()['id']}/take-back/", {"note": "came back"})
    assert (back.json()["amount"], back.json()["takes_back"]) == ("-1.50", paid.json()["id"])


@pytest.mark.parametrize("amount", ["NaN", "0", "-1", "1e400", "0.001", [], True])
def test_what_is_no_amount_is_refused(staff: Caller, ada: Worker, amount: Any) -> None:
    answer = staff.post(f"{PLACE}pay/payments/", {"worker": ada.pseudonym, "amount": amount})
    assert answer.status_code in {400, 409}
    assert not MoneyEntry.objects.exists()


def test_a_submission_is_asked_back(staff: Caller, ada: Worker) -> None:
    assign(Campaign.objects.get(), ada, Assignment.State.SUBMITTED, submission="s2")
    address = f"{PLACE}outbox/return-requests/"
    row = staff.post(address, {"submission": "s2", "reason": "Only one view was looked at"}).json()
    assert (row["kind"], row["state"], row["submission"]) == ("request_return", "planned", "s2")
    assert staff.post(address, {"submission": "s1", "reason": "Why"}).status_code == 409
    assert staff.post(address, {"submission": "s2"}).status_code == 400


def test_tables_come_as_csv(staff: Caller, ada: Worker) -> None:
    answer = staff.get(f"{PLACE}pay/workers.csv")
    assert answer["Content-Type"].startswith("text/csv")
    assert ada.pseudonym in answer.content.decode() and "ada," not in answer.content.decode()
    assert staff.get(f"{PLACE}pay/secrets.csv").status_code == 404


def test_a_payout_is_tried_dry_and_then_planned_and_sent(staff: Caller, ada: Worker) -> None:
    staff.post(f"{PLACE}pay/bonuses/")
    wanted = [("approve", "2.00"), ("bonus_pay", "2.00")]
    dry = staff.post(f"{PLACE}outbox/payouts/", {"dry_run": True}).json()
    assert ([(row["kind"], row["amount"]) for row in dry], OutboxRow.objects.count()) == (wanted, 0)
    staff.post(f"{PLACE}outbox/payouts/", {"dry_run": False})
    assert staff.get(f"{PLACE}outbox/").json()["count"] == 3
    assert staff.get(f"{PLACE}outbox/?state=planned&kind=approve").json()["count"] == 1
    sent = staff.post(f"{PLACE}outbox/send/")
    assert (sent.status_code, sent.json()["kind"]) == (202, "send_outbox")


def test_nothing_is_sent_without_a_key(staff: Caller, ada: Worker) -> None:
    PlatformAccount.objects.update(token="")
    answer = staff.post(f"{PLACE}outbox/send/")
    assert (answer.status_code, Job.objects.count()) == (409, 0)


def test_a_row_is_decided_by_hand(staff: Caller, ada: Worker) -> None:
    staff.post(f"{PLACE}outbox/payouts/", {"dry_run": False})
    row = OutboxRow.objects.get()
    assert staff.post(f"{PLACE}outbox/{row.pk}/", {"action": "happened"}).status_code == 409
    rows.fail(row, "no")
    assert staff.post(f"{PLACE}outbox/{row.pk}/", {"action": "retry"}).json()["state"] == "planned"
    assert staff.post(f"{PLACE}outbox/{row.pk}/", {"action": "withdraw"}).json()["state"] == "withdrawn"


def test_files_go_out_and_are_done(staff: Caller, ada: Worker) -> None:
    staff.post(f"{PLACE}outbox/payouts/", {"dry_run": False})
    file = staff.get(f"{PLACE}outbox/files/approvals.csv")
    assert file.content == b"s1\n"
    done = f"{PLACE}outbox/files/approvals/done/"
    assert [staff.post(done, {"upto": int(file["X-Upto"])}).json() for _ in (1, 2)] == [
        {"done": 1},
        {"done": 0},
    ]
    assert ledger.balance(Campaign.objects.get(), ada.pk).paid == Decimal(2)


def test_a_list_of_submissions_comes_in(staff: Caller, ada: Worker) -> None:
    sent = POSTS["outbox/submissions/"]
    assert staff.post(f"{PLACE}outbox/submissions/", sent).json() == {"lines": 1, "news": 1}
    assert staff.post(f"{PLACE}outbox/submissions/", {"csv": "x"}).status_code == 409


def test_keys_go_in_and_never_come_out(staff: Caller, ada: Worker) -> None:
    answer = staff.post(f"{PLACE}platform/", {"study": "st2", "token": "very-secret", "hook_secret": "hush"})
    assert answer.json()["has_key"] and answer.json()["has_secret"]
    assert "very-secret" not in answer.content.decode() and "hush" not in answer.content.decode()
    assert PlatformAccount.objects.get().token == "very-secret"


@pytest.mark.parametrize(
    "address", ["http://169.254.169.254", "file:///etc/passwd", "https://api.prolific.com.evil"]
)
def test_an_address_the_operator_did_not_name_is_refused(staff: Caller, ada: Worker, address: str) -> None:
    assert staff.post(f"{PLACE}platform/", {"address": address}).status_code == 409
    assert PlatformAccount.objects.get().address == ""


def test_a_study_is_drafted_and_published(staff: Caller, ada: Worker, prolific: Prolific) -> None:
    PlatformAccount.objects.update(study="")
    wanted = {
        "title": "Mark people",
        "description": "In seven views.",
        "address": "https://gtm.example/join/",
        "places": 5,
        "minutes": 15,
        "reward": "2.25",
        "completion_code": "CODE1",
    }
    assert staff.post(f"{PLACE}platform/draft/", wanted).json()["study_state"] == "UNPUBLISHED"
    assert staff.post(f"{PLACE}platform/study/", {"action": "publish"}).json()["study_state"] == "ACTIVE"
    refused = staff.post(f"{PLACE}platform/study/", {"action": "publish"})
    assert (refused.status_code, refused.json()["code"]) == (502, "platform")
    assert "published already" in refused.json()["message"]
