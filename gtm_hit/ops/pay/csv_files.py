"""Pay as CSV: by worker, and line by line. Amounts with a point and two digits, times in UTC."""

from __future__ import annotations

from typing import Any

from gtm_hit.models import Campaign
from gtm_hit.ops.files.csv_text import csv_text
from gtm_hit.ops.pay import table

WORKERS = (
    *("worker", "accepted_batches", "waiting_batches", "active_hours", "currency", "per_hour", "earned"),
    *("bonus_approved", "bonus_proposed", "paid", "on_its_way", "to_pay", "overpaid"),
)
LINES = ("at", "worker", "kind", "amount", "currency", "batch", "by", "note", "takes_back", "line")


def workers(campaign: Campaign) -> str:
    return csv_text(WORKERS, (worker_line(campaign, each) for each in table.workers(campaign)))


def worker_line(campaign: Campaign, each: table.WorkerPay) -> tuple[Any, ...]:
    money = each.balance
    return (
        *(each.worker.pseudonym, each.accepted, each.waiting, each.hours, campaign.currency),
        *("" if each.per_hour is None else each.per_hour, money.earned, money.bonus_approved, each.proposed),
        *(money.paid, money.on_its_way, money.to_pay, money.overpaid),
    )


def ledger_lines(campaign: Campaign) -> str:
    """Oldest first."""
    return csv_text(LINES, (ledger_line(each) for each in table.lines_of(campaign).order_by("at", "pk")))


def ledger_line(each: Any) -> tuple[Any, ...]:
    batch = each.assignment.batch if each.assignment else None
    return (
        *(
            each.at.isoformat(timespec="seconds"),
            each.worker.pseudonym,
            each.kind,
            each.amount,
            each.currency,
        ),
        *(f"{batch.number}/{batch.copy}" if batch else "", each.user.get_username() if each.user else ""),
        *(each.note, each.reverses_id or "", each.pk),
    )
