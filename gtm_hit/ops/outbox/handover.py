"""The outbox by files, where there is no key: what to paste at the platform, and what it gives to download.

Files end at a row. Marking as done takes that row's number, so that what was planned after the download is
not taken for done.
"""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from datetime import datetime

from django.contrib.auth.models import User
from django.db import transaction
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, OutboxRow
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.files.csv_text import harmless
from gtm_hit.ops.outbox import rows, statuses

Kind, State = OutboxRow.Kind, OutboxRow.State
KINDS = {
    "approvals": Kind.APPROVE,
    "rejections": Kind.REJECT,
    "returns": Kind.REQUEST_RETURN,
    "bonuses": Kind.BONUS_PAY,
}
MOST_BYTES = 20_000_000
SUBMISSION = {"submission id", "submission_id", "id", "session id"}
PARTICIPANT = {"participant id", "participant_id", "prolific id"}
STATUS = {"status"}


class HandoverError(OperationError):
    """The file is not taken in; the message says why."""


@dataclass(frozen=True)
class Handover:
    """`upto`: the last row in it; 0 when there is none."""

    text: str
    rows: int
    upto: int


def made(campaign: Campaign, name: str, upto: int | None = None) -> Handover:
    """`approvals`: a submission a line. `bonuses`: `id,amount`, as Prolific's bulk form wants them."""
    if name not in KINDS:
        raise HandoverError(_("There is no such file."))
    found = list(planned(campaign, name, upto))
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    if name in {"rejections", "returns"}:
        writer.writerow(["submission", "category", "message"])
    writer.writerows(line(row) for row in found)
    return Handover(text.getvalue(), len(found), found[-1].pk if found else 0)


def line(row: OutboxRow) -> list[str]:
    match row.kind:
        case Kind.BONUS_PAY:
            return [row.submission, f"{row.amount:.2f}"]
        case Kind.REJECT:
            return [row.submission, row.payload["category"], harmless(row.payload["message"])]
        case Kind.REQUEST_RETURN:
            return [row.submission, "", harmless("; ".join(row.payload["reasons"]))]
    return [row.submission]


def planned(campaign: Campaign, name: str, upto: int | None = None) -> list[OutboxRow]:
    """Without what may have reached the platform by itself."""
    found = OutboxRow.objects.filter(campaign=campaign, kind=KINDS[name], state=State.PLANNED)
    found = found.filter(pk__lte=upto) if upto is not None else found
    return [row for row in found if not rows.perhaps_told(row)]


def done(campaign: Campaign, name: str, upto: int, by: User | None) -> int:
    """Somebody did at the platform what the file says; how many rows that were."""
    if name not in KINDS:
        raise HandoverError(_("There is no such file."))
    confirmed = 0
    for row in planned(campaign, name, upto):
        confirmed += rows.confirm(row.pk, {"by_hand": True}, by, of=[State.PLANNED])
        if row.after_id:
            rows.confirm(row.after_id, {"by_hand": True}, by, of=[State.PLANNED])
    return confirmed


def take_in(campaign: Campaign, content: bytes, now: datetime | None = None) -> tuple[int, int]:
    """Prolific's list of submissions as CSV: lines read, and how many were news. All or nothing."""
    if len(content) > MOST_BYTES:
        raise HandoverError(_("The file is too large for a list of submissions."))
    try:
        lines = list(csv.reader(io.StringIO(content.decode("utf-8-sig"), newline="")))
    except (UnicodeDecodeError, csv.Error) as error:
        raise HandoverError(_("The file is no CSV: %(error)s") % {"error": error}) from None
    found = read(lines, now or timezone.now())
    with transaction.atomic():
        return len(found), statuses.observe_all(campaign, found)


def read(lines: list[list[str]], now: datetime) -> list[statuses.Told]:
    header = [name.strip().lower() for name in lines[0]] if lines else []
    columns = [place(header, names) for names in (SUBMISSION, PARTICIPANT, STATUS)]
    submission, participant, status = columns
    if submission is None or status is None:
        raise HandoverError(_("The first line must name the columns “Submission id” and “Status”."))
    told = []
    for number, cells in enumerate(lines[1:], start=2):
        if not any(cell.strip() for cell in cells):
            continue
        if len(cells) != len(header):
            words = _("Line %(number)d has %(count)d columns instead of %(wanted)d.")
            raise HandoverError(words % {"number": number, "count": len(cells), "wanted": len(header)})
        name = cells[participant].strip()[:255] if participant is not None else ""
        told.append(statuses.Told(cells[submission].strip()[:120], name, word(cells[status]), now))
    return [each for each in told if each.submission and each.status]


def word(status: str) -> str:
    return status.replace("_", " ").strip().upper()[:40]


def place(header: list[str], names: set[str]) -> int | None:
    return next((index for index, name in enumerate(header) if name in names), None)
