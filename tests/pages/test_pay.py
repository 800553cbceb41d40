"""The pages about pay and the platform: who may, what they show, what their buttons do."""

from __future__ import annotations

from typing import Any

import pytest
from django.contrib.auth.models import User
from django.core.files.uploadedfile import SimpleUploadedFile
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Assignment, Campaign, Job, MoneyEntry, OutboxRow, PlatformAccount, Worker
from gtm_hit.ops.outbox import handover, planning, rows
from gtm_hit.ops.pay import table
from tests.paid_campaign import accepted_work, assign, make_campaign, prolific_campaign
from tests.prolific_server import Prolific
from tests.work_scene import make_dataset, make_worker

PLACE = "/datasets/square/campaigns/autumn/"
PAGES = [
    "pay/",
    "pay/payout/",
    "pay/workers.csv",
    "pay/ledger.csv",
    "platform/",
    "platform/files/bonuses.csv",
]
BUTTONS = [
    *("pay/bonuses/", "pay/paid/", "pay/payout/", "pay/lines/1/take-back/", "platform/account/"),
    *("platform/draft/", "platform/study/", "platform/send/", "platform/rows/1/", "platform/files/done/"),
    *("platform/submissions/", "platform/messages/", "platform/return-requests/"),
]


@pytest.fixture
def campaign(db: None, prolific: Prolific) -> Campaign:
    return prolific_campaign(title="Autumn", instructions="Seven views")


@pytest.fixture
def ada(campaign: Campaign) -> Worker:
    return accepted_work(campaign)


@pytest.fixture
def staff(client: Client, db: None) -> Client:
    client.force_login(User.objects.create_user("vera", is_superuser=True))
    return client


def press(staff: Client, button: str, **values: Any) -> str:
    """What the page says afterwards."""
    return staff.post(PLACE + button, values, follow=True).content.decode()


@pytest.mark.parametrize("address", [*PAGES, *BUTTONS])
def test_strangers_and_accounts_without_a_role_see_and_move_nothing(ada: Worker, address: str) -> None:
    curious = Client()
    curious.force_login(User.objects.create_user("curious"))
    for client, status in ((Client(), 302), (curious, 403)):
        assert client.get(PLACE + address).status_code in {status, 405}
        assert client.post(PLACE + address, {"worker": ada.pseudonym}).status_code in {status, 405}
    assert not MoneyEntry.objects.exists() and not OutboxRow.objects.exists() and not Job.objects.exists()


@pytest.mark.parametrize("address", PAGES)
def test_staff_sees_the_page_and_looking_writes_nothing(staff: Client, ada: Worker, address: str) -> None:
    assert staff.get(PLACE + address).status_code == 200
    assert staff.get(PLACE.replace("autumn", "winter") + address).status_code == 404
    assert not MoneyEntry.objects.exists() and not OutboxRow.objects.exists()


@pytest.mark.parametrize("platform", [value for value, _label in Campaign.Platform.choices])
def test_a_campaign_nobody_worked_in_has_its_pages(staff: Client, db: None, platform: str) -> None:
    make_campaign(platform=platform)
    assert "Nobody has worked" in staff.get(f"{PLACE}pay/").content.decode()
    assert staff.get(f"{PLACE}platform/").status_code == 200


def test_bonuses_are_approved_and_paid_by_hand(staff: Client, ada: Worker) -> None:
    assert "1 bonus was approved: 2.00 EUR" in press(staff, "pay/bonuses/")
    assert "4.00 EUR to" in press(staff, "pay/paid/", worker=ada.pseudonym, note="cash")
    assert "nothing to pay" in press(staff, "pay/paid/", worker=ada.pseudonym)
    paid = MoneyEntry.objects.get(kind="paid")
    assert (paid.note, paid.user.username) == ("cash", "vera")
    assert "taken back" in press(staff, f"pay/lines/{paid.pk}/take-back/", note="came back")


def test_the_fields_for_one_worker_open_below_that_row(staff: Client, ada: Worker) -> None:
    assert "Mark as paid" not in staff.get(f"{PLACE}pay/").content.decode()
    page = staff.get(f"{PLACE}pay/?pay={ada.pseudonym}").content.decode()
    assert page.count("Mark as paid") == 1 and "Bonus of your own" in page
    assert "Mark as paid" not in staff.get(f"{PLACE}pay/?pay=nobody").content.decode()


@pytest.mark.parametrize(
    ("button", "amount"), [("pay/paid/", "0"), ("pay/paid/", "x"), ("pay/bonuses/", "-1"), ("pay/paid/", "9")]
)
def test_a_wrong_amount_is_said_and_moves_nothing(
    staff: Client, ada: Worker, button: str, amount: str
) -> None:
    assert 'class="note error"' in press(staff, button, worker=ada.pseudonym, amount=amount)
    assert not MoneyEntry.objects.exclude(kind="earned").exists()


def test_a_payout_is_shown_before_it_is_planned(staff: Client, ada: Worker) -> None:
    press(staff, "pay/bonuses/")
    shown = staff.get(f"{PLACE}pay/payout/").content.decode()
    assert "In all 4.00 EUR" in shown and not OutboxRow.objects.exists()
    assert "Send 3 rows" in press(staff, "pay/payout/")
    assert {row.planned_by.username for row in OutboxRow.objects.all()} == {"vera"}


def test_sending_starts_a_job_and_needs_a_key(staff: Client, ada: Worker) -> None:
    press(staff, "pay/payout/")
    assert "messages to a platform" in press(staff, "platform/send/").lower()
    PlatformAccount.objects.update(token="")
    Job.objects.all().delete()
    assert "There is no key" in press(staff, "platform/send/")
    assert not Job.objects.exists()


def test_rows_are_decided_by_hand(staff: Client, ada: Worker) -> None:
    press(staff, "pay/payout/")
    row = OutboxRow.objects.get()
    place = f"platform/rows/{row.pk}/"
    assert "Only what failed" in press(staff, place, action="retry")
    rows.leave_unclear(row, "lost")
    assert "1 row is unclear" in staff.get(f"{PLACE}platform/").content.decode()
    press(staff, place, action="happened")
    row.refresh_from_db()
    assert (row.state, row.decided_by.username) == ("confirmed", "vera")


def test_a_submission_is_asked_back_and_why_is_shown(staff: Client, ada: Worker, campaign: Campaign) -> None:
    assign(campaign, ada, Assignment.State.SUBMITTED, submission="s2")
    asked = {"submission": "s2", "reason": "Only one view was looked at"}
    page = press(staff, "platform/return-requests/", **asked)
    assert "is asked to give the submission back" in page and asked["reason"] in page
    assert "is decided" in press(staff, "platform/return-requests/", **{**asked, "submission": "s1"})


def test_files_are_downloaded_and_marked_as_done(staff: Client, ada: Worker, campaign: Campaign) -> None:
    press(staff, "pay/payout/")
    assert staff.get(f"{PLACE}platform/files/approvals.csv").content == b"s1\n"
    assert staff.get(f"{PLACE}platform/files/nothing.csv").status_code == 404
    upto = handover.made(campaign, "approvals").upto
    assert "1 row is done" in press(staff, "platform/files/done/", what="approvals", upto=upto)
    assert 'class="note error"' in press(staff, "platform/files/done/", what="approvals", upto="x")


def test_a_list_of_submissions_is_read(staff: Client, ada: Worker) -> None:
    file = SimpleUploadedFile("list.csv", b"Submission id,Status\ns1,APPROVED\n", "text/csv")
    assert "1 submission was read; news: 1" in press(staff, "platform/submissions/", file=file)
    assert "Choose a file" in press(staff, "platform/submissions/")


def test_a_key_is_kept_and_shown_nowhere(staff: Client, ada: Worker, prolific: Prolific) -> None:
    shown = press(staff, "platform/account/", address=prolific.base, study="st1", token="very-secret")
    assert "was changed" in shown and "very-secret" not in shown
    assert PlatformAccount.objects.get().token == "very-secret"
    assert 'class="note error"' in press(staff, "platform/account/", address="http://10.0.0.1", token="other")
    assert PlatformAccount.objects.get().token == "very-secret"
    staff.force_login(User.objects.create_superuser("chief"))
    row = PlatformAccount.objects.get()
    assert b"very-secret" not in staff.get(f"/admin/gtm_hit/platformaccount/{row.pk}/change/").content


def test_a_study_is_drafted_and_published(staff: Client, ada: Worker, prolific: Prolific) -> None:
    PlatformAccount.objects.update(study="")
    wanted = {
        "title": "Mark people",
        "description": "In seven views.",
        "address": "http://gtm.example/",
        "places": 5,
        "minutes": 15,
        "reward": "2.25",
        "completion_code": "CODE1",
    }
    refused = staff.post(f"{PLACE}platform/draft/", wanted)
    assert refused.status_code == 400 and "https://" in refused.content.decode()
    shown = press(staff, "platform/draft/", **{**wanted, "address": "https://gtm.example/"})
    assert "The study is drafted" in shown and "Publish" in shown
    assert "The study is ACTIVE now" in press(staff, "platform/study/", action="publish")
    assert "0 of 5 places" in press(staff, "platform/study/", action="look")


def test_the_pages_ask_the_database_as_often_for_many_workers(staff: Client, campaign: Campaign) -> None:
    def grow(start: int, count: int) -> None:
        for number in range(start, start + count):
            worker = make_worker(f"w{number}", "prolific")
            assign(campaign, worker, Assignment.State.ACCEPTED, minutes=30, submission=f"w{number}")
        table.approve_bonuses(campaign, None)
        planning.plan_payouts(campaign, None)

    def asked(page: str) -> int:
        with CaptureQueriesContext(connection) as captured:
            assert staff.get(PLACE + page).status_code == 200
        return len(captured)

    grow(0, 1)
    few = [asked(page) for page in ("pay/", "platform/")]
    grow(1, 5)
    assert [asked(page) for page in ("pay/", "platform/")] == few


def test_another_campaigns_rows_and_lines_are_not_reached(staff: Client, ada: Worker) -> None:
    other = make_campaign(make_dataset("other", 60), name="autumn")
    assign(other, ada, Assignment.State.ACCEPTED, minutes=30)
    (bonus,) = table.approve_bonuses(other, None)
    answer = staff.post(f"{PLACE}pay/lines/{bonus.pk}/take-back/", {"note": "x"})
    assert answer.status_code == 404
