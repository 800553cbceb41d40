"""Modules do nothing when they are imported: only what a page starts with reads the page."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page

from tests.conftest import REPOSITORY

pytestmark = pytest.mark.browser

STATIC = REPOSITORY / "static"
STARTING = {
    path.relative_to(STATIC).as_posix() for name in ("main.js", "start.js") for path in STATIC.rglob(name)
}
SCRIPTS = {
    f"site/{path.name}" for path in (STATIC / "site").glob("*.js")
}  # of ordinary pages, run as they are

WORKERS = {"tables/grid_worker.js"}  # what it is started for is to listen


def modules() -> list[str]:
    every = {path.relative_to(STATIC).as_posix() for path in STATIC.rglob("*.js")}
    return sorted(every - STARTING - SCRIPTS - WORKERS)


def test_every_module_can_be_imported_where_there_is_no_page(module_page: Page) -> None:
    """A worker has no window, no document and no styles."""
    problems = module_page.evaluate(
        """async (names) => {
            const body = `onmessage = async ({ data }) => {
              const problems = [];
              const listen = self.addEventListener;
              self.addEventListener = (name) => problems.push("listens to " + name);
              for (const name of data) {
                await import(name).catch((error) => problems.push(name + ": " + error.message));
              }
              postMessage(problems);
            };`;
            const address = URL.createObjectURL(new Blob([body], { type: "text/javascript" }));
            const worker = new Worker(address, { type: "module" });
            const answer = new Promise((done) => (worker.onmessage = ({ data }) => done(data)));
            worker.postMessage(names.map((name) => `${location.origin}/static/${name}`));
            return answer;
        }""",
        modules(),
    )
    assert problems == []
