"""A detector at an address, over real HTTP: as CVAT's serverless ones are, or one that takes all views.

What it is told to do wrong (`wrong`) it does with every question but /health.
"""

from __future__ import annotations

import base64
import io
import json
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from PIL import Image

PERSON = {"confidence": "0.91", "label": "person", "type": "rectangle"}


@dataclass
class DetectorServer:
    multi_view: bool = False
    wrong: str = ""  # status, html, huge, slow, drops, redirect
    answer: Any = None  # instead of what it would find
    asked: list[dict[str, Any]] = field(default_factory=list)
    address: str = ""

    def found(self, body: dict[str, Any]) -> Any:
        if self.answer is not None:
            return self.answer
        if self.multi_view:
            return {"model_version": "3", "ground": [{"x": 0.5, "y": -1.0, "score": 0.8, "person": 4}]}
        image = Image.open(io.BytesIO(base64.b64decode(body["image"])))
        width, height = image.size
        box = [0.45 * width, 0.3 * height, 0.55 * width, 0.7 * height]
        car = {"confidence": 0.9, "label": "car", "type": "rectangle", "points": [0, 0, 5, 5]}
        return [{**PERSON, "points": box}, car]


@contextmanager
def serving(state: DetectorServer) -> Iterator[DetectorServer]:
    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            if self.path == "/health" and state.multi_view:
                self._send(200, json.dumps({"multi_view": True, "model_version": "3"}).encode())
            else:
                self._send(500, b"body has no image")  # what CVAT's functions do

        def do_POST(self) -> None:
            body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            state.asked.append(body)
            with suppress(OSError):  # whoever asked has left
                getattr(self, f"_{state.wrong}", self._right)(body)

        def _right(self, body: dict[str, Any]) -> None:
            self._send(200, json.dumps(state.found(body)).encode())

        def _status(self, _body: Any) -> None:
            self._send(503, b"out of memory")

        def _html(self, _body: Any) -> None:
            self._send(200, b"<html>")

        def _huge(self, _body: Any) -> None:
            self._send(200, b"[" + b" " * 200_000 + b"]")

        def _slow(self, _body: Any) -> None:
            self.send_response(200)
            self.end_headers()
            for _ in range(40):  # never silent for long
                self.wfile.write(b" ")
                time.sleep(0.05)

        def _drops(self, _body: Any) -> None:
            self.close_connection = True

        def _redirect(self, _body: Any) -> None:
            self.send_response(307)
            self.send_header("Location", f"{state.address}/elsewhere")
            self.send_header("Content-Length", "0")
            self.end_headers()

        def _send(self, status: int, content: bytes) -> None:
            self.send_response(status)
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, *_told: Any) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True)
    thread.start()
    state.address = f"http://127.0.0.1:{server.server_port}"
    try:
        yield state
    finally:
        server.shutdown()
        server.server_close()
