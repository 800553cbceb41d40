"""Whatever managers do, whatever gets lost: nobody is paid twice, and the ledger agrees with the platform."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from datetime import timedelta
from decimal import Decimal
from typing import Any

from django.db.models import Sum
from django.test import override_settings
from django.utils import timezone
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.extra.django import TestCase
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

from gtm_hit.crowd.prolific_client import bonus_lines, work_of
from gtm_hit.models import Assignment, Campaign, MoneyEntry, OutboxRow, Worker
from gtm_hit.ops.outbox import planning, rows, sending, statuses
from gtm_hit.ops.outbox.platform import (
    Bonus,
    NotSent,
    Refused,
    Study,
    StudyDraft,
    TooFast,
    Unanswered,
    WorkAtPlatform,
)
from gtm_hit.ops.pay import ledger, table
from tests.ops.outbox.conftest import REASON
from tests.paid_campaign import assign, become, make_account, make_campaign
from tests.prolific_server import Prolific
from tests.work_scene import make_dataset, make_worker

State = Assignment.State
FAULTS = ["", "", "", "no connection", "too fast", "lost before", "lost after"]
REFUSALS = (ledger.PayError, planning.PlanError, rows.RowError, Refused)


class Killed(Exception):
    """The process is gone between request and answer."""


class Direct:
    """The stand-in without the wire: the same answers, and faults on demand."""

    def __init__(self, server: Prolific) -> None:
        self.server, self.faults = server, list[str]()

    def ask(self, method: str, path: str, body: Any = None) -> Any:
        fault = self.faults.pop(0) if self.faults and method == "POST" else ""
        if fault == "no connection":
            raise NotSent(fault)
        if fault == "too fast":
            raise TooFast(3600)
        if fault == "lost before":
            raise Unanswered(fault)
        status, answer = self.server.answer(
            method, path, {"study": ["st1"], "page_size": ["500"]}, body or {}
        )
        if fault == "killed":
            raise Killed
        if fault == "lost after":
            raise Unanswered(fault)
        if status >= 400:
            raise Refused(status, str(answer))
        return answer

    def approve(self, submission: str) -> None:
        self.ask("POST", f"/api/v1/submissions/{submission}/transition/", {"action": "APPROVE"})

    def reject(self, submission: str, message: str, category: str) -> None:
        body = {"action": "REJECT", "message": message, "rejection_category": category}
        self.ask("POST", f"/api/v1/submissions/{submission}/transition/", body)

    def request_return(self, submission: str, reasons: list[str]) -> None:
        body = {"request_return_reasons": reasons}
        self.ask("POST", f"/api/v1/submissions/{submission}/request-return/", body)

    def set_up_bonuses(self, study: str, bonuses: list[Bonus]) -> str:
        body = {"study_id": study, "csv_bonuses": bonus_lines(bonuses)}
        return str(self.ask("POST", "/api/v1/submissions/bonus-payments/", body)["id"])

    def pay_bonuses(self, prepared: str) -> None:
        self.ask("POST", f"/api/v1/bulk-bonus-payments/{prepared}/pay/")

    def submission(self, submission: str) -> WorkAtPlatform:
        return work_of(self.ask("GET", f"/api/v1/submissions/{submission}/"))

    def submissions(self, study: str) -> Iterator[WorkAtPlatform]:
        yield from map(work_of, self.ask("GET", "/api/v1/submissions/")["results"])

    def make_secret(self, workspace: str) -> str:
        raise NotImplementedError

    def subscribe(self, workspace: str, event: str, target: str) -> None:
        raise NotImplementedError

    def create_study(self, draft: StudyDraft) -> Study:
        raise NotImplementedError

    def study(self, identifier: str) -> Study:
        raise NotImplementedError

    def change_study(self, identifier: str, action: str) -> Study:
        raise NotImplementedError


class Paying(RuleBasedStateMachine):
    """Two workers, six batches; the second and third of the first worker are one submission."""

    steps: Counter[str] = Counter()

    @initialize()
    def begin(self) -> None:
        self.server = Prolific(studies={"st1": {"id": "st1", "status": "ACTIVE"}})
        self.platform = Direct(self.server)
        name = f"d{Campaign.objects.count()}"
        self.campaign = make_campaign(make_dataset(name, 60), platform=Campaign.Platform.PROLIFIC)
        make_account(self.campaign, token="x")
        self.workers = [make_worker(f"{name}-{number}", "prolific") for number in (1, 2)]
        self.work = [
            assign(self.campaign, self.workers[who], State.SUBMITTED, minutes=minutes, submission=submission)
            for who, minutes, submission in (
                *((0, 30, "a1"), (0, 10, "a2"), (0, 50, "a2")),
                *((1, 20, "b1"), (1, 40, "b2"), (1, 15, "")),
            )
        ]
        for worker, names in zip(self.workers, (("a1", "a2"), ("b1", "b2")), strict=True):
            for submission in names:
                self.server.add(submission, worker.external_id)
        self.by_hand = Decimal(0)
        for which in (0, 1, 3, 5):
            self.decide(which, "accepted")

    def attempt(self, step: str, action: Any) -> Any:
        self.steps[step] += 1
        try:
            return action()
        except REFUSALS:
            return None

    @rule(which=st.integers(0, 5), outcome=st.sampled_from(["accepted", "accepted", "returned", "rejected"]))
    def decide(self, which: int, outcome: str) -> None:
        become(self.work[which], outcome)
        reason = {"message": REASON, "category": "LOW_EFFORT"}
        self.attempt("decide", lambda: planning.plan_decision(self.work[which], outcome, **reason))

    @rule(
        own=st.one_of(st.none(), st.sampled_from([Decimal("0.50"), Decimal("2.00")])), who=st.integers(0, 1)
    )
    def approve_bonus(self, own: Decimal | None, who: int) -> None:
        only = None if own is None else [self.workers[who].pseudonym]
        self.attempt("bonus", lambda: table.approve_bonuses(self.campaign, None, only, own))

    @rule(who=st.integers(0, 1), part=st.sampled_from([None, Decimal("0.75")]))
    def pay_by_hand(self, who: int, part: Decimal | None) -> None:
        paid = self.attempt("hand", lambda: ledger.mark_paid(self.campaign, self.workers[who], None, part))
        self.by_hand += paid.amount if paid else 0

    @rule()
    def plan(self) -> None:
        self.attempt("plan", lambda: planning.plan_payouts(self.campaign, None))

    @rule(faults=st.lists(st.sampled_from([*FAULTS, "killed"]), max_size=6))
    def send(self, faults: list[str]) -> None:
        self.steps["send"] += 1
        self.platform.faults = faults
        OutboxRow.objects.update(not_before=None)
        try:
            sending.send(self.campaign, self.platform, lambda done, total: None)
        except Killed:
            self.steps["killed"] += 1

    @rule(faults=st.lists(st.sampled_from([*FAULTS, "killed", "killed"]), min_size=4, max_size=10))
    def whole_round(self, faults: list[str]) -> None:
        self.approve_bonus(None, 0)
        self.plan()
        self.send(faults)

    @rule(slow=st.booleans())
    def booking(self, slow: bool) -> None:
        """The platform books bonuses at once, or some time later."""
        self.server.slow = slow
        if not slow:
            self.server.book()

    @rule()
    def hour_passes(self) -> None:
        """By then everything the platform ever books is booked."""
        self.server.book()
        OutboxRow.objects.filter(state="sent").update(sent_at=timezone.now() - timedelta(hours=1))

    @rule()
    def ask(self) -> None:
        statuses.ask_all(self.campaign, self.platform)

    @precondition(lambda self: OutboxRow.objects.filter(state="unclear", kind="bonus_pay").exists())
    @rule()
    def look_and_decide(self) -> None:
        """A person who looks at the platform sees what is there."""
        self.server.book()
        row = OutboxRow.objects.filter(state="unclear", kind="bonus_pay").order_by("pk")[0]
        known = OutboxRow.objects.filter(kind="bonus_pay", submission=row.submission, state="confirmed")
        booked = len([1 for to, _cents in self.server.payments if to == row.submission])
        self.attempt("look", lambda: rows.resolve(row, booked > known.count(), None))

    @rule(which=st.integers(0, 20))
    def retry_or_withdraw(self, which: int) -> None:
        found = list(OutboxRow.objects.filter(state__in=["failed", "planned"]).order_by("pk"))
        if found:
            row = found[which % len(found)]
            self.attempt(
                "retry", lambda: rows.decide(row, "retry" if row.state == "failed" else "withdraw", None)
            )

    @invariant()
    def nothing_is_paid_twice(self) -> None:
        if not hasattr(self, "server"):
            return
        rewards = Decimal(2) * sum(one["status"] == "APPROVED" for one in self.server.submissions.values())
        bonuses = Decimal(sum(cents for _to, cents in self.server.payments)) / 100
        sums = {kind: Decimal(0) for kind in MoneyEntry.Kind.values}
        for kind, total in MoneyEntry.objects.values_list("kind").annotate(total=Sum("amount")):
            sums[kind] = total
        waiting = OutboxRow.objects.filter(kind__in=OutboxRow.MONEY, state__in=OutboxRow.UNDER_WAY)
        on_its_way = waiting.aggregate(total=Sum("amount"))["total"] or Decimal(0)
        # What left our hands is in the ledger, or known to be on its way; and never more than was owed once.
        left = rewards + bonuses + self.by_hand
        assert sums["paid"] <= left <= sums["paid"] + on_its_way
        booked = MoneyEntry.objects.filter(kind__in=["earned", "bonus_approved"], amount__gt=0)
        assert left <= (booked.aggregate(total=Sum("amount"))["total"] or 0)

    @invariant()
    def the_table_agrees_with_the_ledger(self) -> None:
        if not hasattr(self, "server"):
            return
        lines = {each.worker.pk: each.balance for each in table.workers(self.campaign)}
        with ledger.holding(self.campaign) as held:
            ledger.settle(held)
        for worker in Worker.objects.filter(pk__in=lines):
            assert ledger.balance(self.campaign, worker.pk) == lines[worker.pk]
            assert lines[worker.pk].to_pay >= 0 <= lines[worker.pk].overpaid


class MoneyTest(TestCase):
    def test_no_order_of_events_pays_anybody_twice(self) -> None:
        class Machine(Paying):
            def teardown(self) -> None:
                for model in (MoneyEntry, OutboxRow):
                    rows_of = model.objects.all()
                    rows_of._raw_delete(rows_of.db)

        few = settings(
            max_examples=25,
            stateful_step_count=30,
            deadline=None,
            database=None,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        with override_settings(PROLIFIC_ADDRESSES=["http://127.0.0.1:9"]):
            run_state_machine_as_test(Machine, settings=few)
        print(f"\nmoney: {Paying.steps.total()} steps: {dict(Paying.steps)}")
        assert Paying.steps["send"] and Paying.steps["hand"]
