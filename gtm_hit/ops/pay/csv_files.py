"""Pay as CSV: by worker, and line by line. Amounts with a point and two digits, times in UTC."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from typing import Any

from gtm_hit.models import Campaign
from gtm_hit.ops.pay import table

WORKERS = (
    *("worker", "accepted_batches", "waiting_batches", "active_hours", "currency", "per_hour", "earned"),
    *("bonus_approved", "bonus_proposed", "paid", "on_its_way", "to_pay", "overpaid"),
)
LINES = ("at", "worker", "kind", "amount", "currency", "batch", "by", "note", "takes_back", "line")


def workers(campaign: Campaign) -> str:
    return written(WORKERS, (worker_line(campaign, each) for each in table.workers(campaign)))


def worker_line(campaign: Campaign, each: table.WorkerPay) -> tuple[Any, ...]:
    money = each.balance
    return (
        *(each.worker.pseudonym, each.accepted, each.waiting, each.hours, campaign.currency),
        *("" if each.per_hour is None else each.per_hour, money.earned, money.bonus_approved, each.proposed),
        *(money.paid, money.on_its_way, money.to_pay, money.overpaid),
    )


def ledger_lines(campaign: Campaign) -> str:
    """Oldest first."""
    return written(LINES, (ledger_line(each) for each in table.lines_of(campaign).order_by("at", "pk")))


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


def written(header: Iterable[str], rows: Iterable[tuple[Any, ...]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([safe(value) for value in row] for row in rows)
    return text.getvalue()


def safe(value: Any) -> Any:
    """Words that a spreadsheet would take for a formula are told from one; numbers are not."""
    return f"'{value}" if isinstance(value, str) and value[:1] in {"=", "+", "-", "@", "\t", "\r"} else value
