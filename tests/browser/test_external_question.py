"""A panel on another site frames the task, with third-party cookies blocked, and gets the form."""

from __future__ import annotations

import json
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any
from urllib.parse import parse_qs, urlencode

import pytest
from playwright.sync_api import BrowserContext, BrowserType, FrameLocator, Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Assignment, Worker
from gtm_hit.ops.campaigns import links as campaign_links
from tests.browser.conftest import ARGUMENTS, CHROMIUM
from tests.browser.street import make_street
from tests.campaign_scene import make_campaign

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

SIZE = {"width": 1600, "height": 900}
BLOCKED = {"profile": {"cookie_controls_mode": 1, "block_third_party_cookies": True}}


# What a frame that may have cookies reads back.
PROBE = """() => {
    document.cookie = "probe=1; SameSite=None; Secure";
    return document.cookie;
}"""


class Panel:
    """Another site: a page around the task, and the address its form goes to."""

    def __init__(self) -> None:
        self.shown = ""
        self.received: list[dict[str, list[str]]] = []
        panel = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                self.answer(
                    f'<!doctype html><title>panel</title><iframe src="{panel.shown}" '
                    'style="position:fixed;inset:0;width:100%;height:100%;border:0"></iframe>'
                )

            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["Content-Length"])).decode()
                if self.path == "/mturk/externalSubmit":
                    panel.received.append(parse_qs(body))
                self.answer("<!doctype html><title>thanks</title><h1>The panel has it</h1>")

            def answer(self, page: str) -> None:
                self.send_response(200)
                self.send_header("Content-Type", "text/html")
                self.end_headers()
                self.wfile.write(page.encode())

            def log_message(self, *args: Any) -> None:
                pass

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.origin = f"http://127.0.0.1:{self.server.server_port}"


@pytest.fixture
def panel() -> Iterator[Panel]:
    panel = Panel()
    Thread(target=panel.server.serve_forever, daemon=True).start()
    yield panel
    panel.server.shutdown()


@pytest.fixture
def strict(browser_type: BrowserType, tmp_path: Path) -> Iterator[BrowserContext]:
    """A browser that gives a page in another site's frame no cookies."""
    (tmp_path / "Default").mkdir()
    (tmp_path / "Default" / "Preferences").write_text(json.dumps(BLOCKED))
    context = browser_type.launch_persistent_context(
        tmp_path, executable_path=CHROMIUM, args=ARGUMENTS, viewport=SIZE
    )
    yield context
    context.close()


def show(page: Page, panel: Panel, entry: str, **given: str) -> FrameLocator:
    panel.shown = f"{entry}?{urlencode({'hitId': 'H1', 'turkSubmitTo': panel.origin, **given})}"
    page.goto(panel.origin)
    return page.frame_locator("iframe")


@pytest.mark.flaky(reruns=2)
def test_from_the_preview_to_the_posted_form(
    strict: BrowserContext, panel: Panel, live_server: LiveServer, settings: Any
) -> None:
    settings.EMBEDDING_ORIGINS = [panel.origin]
    # Another site than the panel's: a name, where the panel has a number.
    server = live_server.url.replace("127.0.0.1", "localhost")
    assert "localhost" in server
    own = {"frame_ancestors": [panel.origin], "submit_to": [panel.origin]}
    street = make_street(people=3, frames=1)
    campaign = make_campaign(street.dataset, platform="external_question", platform_settings=own, overlap=0)
    entry = f"{server}/join/{campaign_links.token(campaign_links.make(campaign))}/"
    page, errors = strict.new_page(), []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda said: errors.append(said.text) if "Content Security" in said.text else None)

    frame = show(page, panel, entry, assignmentId="ASSIGNMENT_ID_NOT_AVAILABLE")
    expect(frame.get_by_text("This is a preview")).to_be_visible()
    assert not Worker.objects.exists()

    frame = show(page, panel, entry, assignmentId="A1", workerId="W1")
    assert frame.locator("body").evaluate(PROBE) == ""
    frame.get_by_role("button", name="Start").click()
    frame.get_by_role("button", name="start", exact=False).last.click()
    expect(frame.locator("#workbench")).to_have_attribute("data-ready", "true", timeout=30_000)
    frame.locator('[data-view="camera-0"]').click()
    page.keyboard.press("n")
    frame.get_by_role("dialog").get_by_role("button", name="Submit").click()

    expect(frame.get_by_role("heading", name="The panel has it")).to_be_visible(timeout=20_000)
    done = Assignment.objects.get()
    assert (done.state, done.submission) == ("submitted", "A1")
    assert panel.received == [{"assignmentId": ["A1"], "code": [done.code]}]
    assert strict.cookies(server) == []
    assert errors == []


def test_another_site_than_the_listed_one_shows_nothing(
    page: Page, panel: Panel, live_server: LiveServer, settings: Any
) -> None:
    settings.EMBEDDING_ORIGINS = ["https://panel.example"]
    campaign = make_campaign(make_street(1, 1).dataset, platform="external_question", overlap=0)
    entry = f"{live_server.url}/join/{campaign_links.token(campaign_links.make(campaign))}/"
    refused: list[str] = []
    page.on("console", lambda said: refused.append(said.text))
    show(page, panel, entry, assignmentId="ASSIGNMENT_ID_NOT_AVAILABLE")
    page.wait_for_timeout(500)
    assert [one for one in refused if "frame-ancestors" in one or "Refused to" in one or "violates" in one]
