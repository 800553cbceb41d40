"""A browser that is killed, with nothing said to it before: the journal has what was done."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Playwright, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Save
from tests.browser.bench import Bench, metres_apart
from tests.browser.conftest import ARGUMENTS, CHROMIUM
from tests.browser.street import annotate, make_street

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True), pytest.mark.flaky(reruns=2)]

# No save begins: the delay from an edit to its save is stretched.
NEVER_SENT = """
const real = window.setTimeout;
window.setTimeout = (work, ms, ...more) => real(work, ms === 700 ? 600_000 : ms, ...more);
"""


class Browser:
    """A Chromium of its own, with a profile that outlives it."""

    def __init__(self, playwright: Playwright, profile: Path, script: str = "") -> None:
        port_file = profile / "DevToolsActivePort"
        port_file.unlink(missing_ok=True)
        arguments = [*ARGUMENTS, "--headless=new", "--remote-debugging-port=0", f"--user-data-dir={profile}"]
        self.process = subprocess.Popen(
            [CHROMIUM, *arguments], start_new_session=True, stderr=subprocess.DEVNULL
        )
        browser = playwright.chromium.connect_over_cdp(f"http://127.0.0.1:{port_in(port_file)}")
        self.page = browser.contexts[0].new_page()
        self.page.set_viewport_size({"width": 1920, "height": 1080})
        if script:
            self.page.add_init_script(script)

    def kill(self) -> None:
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()


def port_in(file: Path) -> str:
    for _ in range(300):
        if file.exists() and (lines := file.read_text().splitlines()):
            return lines[0]
        time.sleep(0.1)
    raise RuntimeError("Chromium does not start")


@pytest.fixture
def start(
    playwright: Playwright, live_server: LiveServer, tmp_path: Path
) -> Iterator[Callable[..., tuple[Browser, Bench]]]:
    """Start a browser, again and again with the same profile, in the workbench of the same batch."""
    street = make_street(2, 3)
    assignment = street.claim()
    annotate(assignment, street.frames[0], street.truth[0])
    started: list[Browser] = []

    def start(script: str = "") -> tuple[Browser, Bench]:
        started.append(Browser(playwright, tmp_path / "profile", script))
        return started[-1], Bench(started[-1].page, live_server, street, assignment).open()

    yield start
    for browser in started:
        browser.kill()


def test_edits_of_a_browser_killed_before_its_first_send_are_saved_by_the_next(
    start: Callable[..., tuple[Browser, Bench]],
) -> None:
    browser, opened = start(NEVER_SENT)
    before = opened.stored()[0].position
    opened.press("Tab", *["ArrowLeft"] * 4)
    opened.page.wait_for_timeout(100)
    browser.kill()
    assert Save.objects.count() == 1
    _browser, opened = start()
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2", timeout=15_000)
    assert metres_apart(before, opened.stored()[0].position) == pytest.approx(0.1, abs=1e-6)


def test_a_browser_killed_in_a_burst_of_keys_has_kept_the_burst(
    start: Callable[..., tuple[Browser, Bench]],
) -> None:
    browser, opened = start(NEVER_SENT)
    before = opened.stored()[0].position
    opened.press("Tab")
    for _ in range(20):
        opened.press("ArrowLeft")
        opened.page.wait_for_timeout(33)
    browser.kill()
    _browser, opened = start()
    expect(opened.page.locator(".save-words")).to_have_text("All saved · r2", timeout=15_000)
    assert metres_apart(before, opened.stored()[0].position) == pytest.approx(0.5, abs=1e-6)
