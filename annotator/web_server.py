"""The web server of a local start: `python -m annotator.web_server --host 127.0.0.1 --port 8000`.

It takes requests and sends answers beside the threads that work on them, so that however many clients are
slow or silent, none of them holds a thread.
"""

from __future__ import annotations

import argparse
import re
import signal
import sys
import tempfile
from types import FrameType
from typing import NoReturn

from django.conf import settings
from waitress.channel import HTTPChannel
from waitress.parser import HTTPRequestParser
from waitress.server import create_server
from waitress.utilities import Error

from annotator.wsgi import application

THREADS = 8
CONNECTIONS = 1000  # far more than threads: waiting costs a file descriptor
SILENCE_SECONDS = 120
MEGABYTE = 1_000_000
ORDINARY_BYTES = 16 * MEGABYTE  # calibration and text files are the largest after archives
FORM_BYTES = 1 * MEGABYTE  # around the file of a form, generously
# As in deploy/nginx.conf.
TAKES_ARCHIVES = re.compile(r"/(imports|import-annotations|uploads)/$")


class NotSignedIn(Error):
    code = 401
    reason = "Unauthorized"


class BodyTooLarge(Error):
    code = 413
    reason = "Request Entity Too Large"


class BoundedParser(HTTPRequestParser):
    """Looks at address and length before a body is taken in: only archives are large, strangers send none."""

    error: Error | None

    def received(self, data: bytes) -> int:
        consumed = int(super().received(data))
        if self.headers_finished and self.error is None and (refusal := self.refusal()):
            self.error = refusal
            self.completed = True
        return consumed

    def refusal(self) -> Error | None:
        length = max(self.content_length, self.body_bytes_received)
        if length <= ORDINARY_BYTES:
            return None
        if not TAKES_ARCHIVES.search(self.path):
            return BodyTooLarge(f"At most {ORDINARY_BYTES // MEGABYTE} MB are taken here.")
        if not {"AUTHORIZATION", "COOKIE"} & set(self.headers):
            return NotSignedIn("Sign in, or send a key.")
        return None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--host", required=True)
    parser.add_argument("--port", type=int, required=True)
    options = parser.parse_args()
    signal.signal(signal.SIGTERM, end)
    tempfile.tempdir = settings.FILE_UPLOAD_TEMP_DIR  # large bodies wait there
    HTTPChannel.parser_class = BoundedParser
    server = create_server(
        application,
        listen=f"[{options.host}]:{options.port}"
        if ":" in options.host
        else f"{options.host}:{options.port}",
        threads=THREADS,
        connection_limit=CONNECTIONS,
        channel_timeout=SILENCE_SECONDS,
        asyncore_use_poll=True,
        max_request_body_size=settings.MAX_UPLOAD_MB * MEGABYTE + FORM_BYTES,
        # Behind TLS somebody else answers for X-Forwarded-Proto; otherwise nobody may claim it.
        clear_untrusted_proxy_headers=not settings.SECURE,
        url_prefix=settings.SCRIPT_NAME,
        ident="",
    )
    server.run()
    return 0


def end(_number: int, _frame: FrameType | None) -> NoReturn:
    raise SystemExit(0)


if __name__ == "__main__":
    sys.exit(main())
