"""Links to work are keys; the log is read by more people than may use them."""

from __future__ import annotations

import logging
import re

# As in deploy/nginx.conf.
KEY = re.compile(
    r"(/(?:join|work|annotate|invitation)/|%2F(?:join|work|annotate|invitation)%2F)[^/?&\s'\"%]+",
    re.IGNORECASE,
)


class MaskingFormatter(logging.Formatter):
    def format(self, record: logging.LogRecord) -> str:
        return KEY.sub(r"\1…", super().format(record))
