"""A real Chromium, Debian's, for every browser test."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread
from typing import Any

import pytest
from playwright.sync_api import Page
from pytest_django.live_server_helper import LiveServer

from tests.browser.bench import Bench
from tests.browser.street import annotate, make_street
from tests.conftest import REPOSITORY

CHROMIUM = "/usr/bin/chromium"
ARGUMENTS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]

# Playwright's calls run in an event loop of their own; the live server's database is used outside it.
os.environ.setdefault("DJANGO_ALLOW_ASYNC_UNSAFE", "true")


@pytest.fixture(scope="session")
def browser_type_launch_args(browser_type_launch_args: dict[str, Any]) -> dict[str, Any]:
    return {**browser_type_launch_args, "executable_path": CHROMIUM, "args": ARGUMENTS}


class _StaticFiles(SimpleHTTPRequestHandler):
    """/static/ from the repository, and at / a page with nothing on it, for modules to be imported into."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args, directory=str(REPOSITORY))

    def do_GET(self) -> None:
        if self.path == "/":
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(b"<!doctype html><link rel='icon' href='data:,'><title>modules</title>")
        elif self.path.startswith("/static/"):
            super().do_GET()
        else:
            self.send_error(404)

    def log_message(self, *args: Any) -> None:
        pass


@pytest.fixture(scope="session")
def static_server() -> Iterator[str]:
    with ThreadingHTTPServer(("127.0.0.1", 0), _StaticFiles) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@pytest.fixture
def module_page(page: Page, static_server: str) -> Page:
    """An empty page that can import the modules under /static/."""
    page.goto(static_server)
    return page


@pytest.fixture
def bench(page: Page, live_server: LiveServer) -> Iterator[Callable[..., Bench]]:
    """Make a street with a worker's batch, its first frame annotated with the truth if `marked`."""
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.set_viewport_size({"width": 1920, "height": 1080})

    def make(people: int = 4, frames: int = 3, marked: bool = True) -> Bench:
        street = make_street(people, frames)
        assignment = street.claim()
        if marked:
            annotate(assignment, street.frames[0], street.truth[0])
        return Bench(page, live_server, street, assignment)

    yield make
    assert errors == []


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """On a machine with every core busy Chromium may miss a time limit; what is wrong fails three times."""
    for item in items:
        if "page" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.flaky(reruns=2))
