"""Tables as CSV that a spreadsheet opens and runs nothing of."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from typing import Any

# A spreadsheet takes a cell that begins like this for a formula.
FORMULA = ("=", "+", "-", "@", "\t", "\r")


def csv_text(header: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """A line of names, then the rows; nothing at all for no names."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    if names := list(header):
        writer.writerow(names)
    writer.writerows([harmless(cell) for cell in row] for row in rows)
    return text.getvalue()


def harmless(cell: Any) -> Any:
    """Words that a spreadsheet would take for a formula are told from one; numbers are not."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(FORMULA) else cell
