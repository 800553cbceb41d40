"""The people of the whole story, and the site they meet at: processes of its own."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import numpy as np
from playwright.sync_api import Browser, Page, expect

from tests.browser.story_scene import FRAMES, PASSWORD, PEOPLE
from tests.browser.street import FRAME_STEP, GRID, walks
from tests.conftest import REPOSITORY
from tests.ops.site import Site
from tests.prolific_server import Prolific
from tests.services import free_port, wait_for_port

DATASET = "datasets/street/"
TRUTH = {FRAME_STEP * index: list(map(int, places)) for index, places in enumerate(walks(PEOPLE, FRAMES))}
Rows = list[dict[str, Any]]
COLLECT = "import django; django.setup(); from annotator.local import collect_static; collect_static()"


@contextmanager
def web_server(site: Site) -> Iterator[str]:
    """The web server of production; its address."""
    port = free_port()
    command = [sys.executable, "-m", "gunicorn", "annotator.wsgi", "--bind", f"127.0.0.1:{port}"]
    command += ["--worker-class", "gthread", "--workers", "1", "--threads", "8"]
    with (site.folder / "web.log").open("wb") as log:
        process = subprocess.Popen(
            command, cwd=REPOSITORY, env=site.environment, stdout=log, stderr=log, start_new_session=True
        )
        try:
            wait_for_port(port)
            yield f"http://127.0.0.1:{port}"
        finally:
            os.killpg(process.pid, signal.SIGTERM)
            process.wait(timeout=30)


class Script:
    """Somebody's REST key."""

    def __init__(self, site: Site, address: str, user: str, *scopes: str) -> None:
        asked = [word for scope in scopes for word in ("--scope", scope)]
        key = site.python("manage.py", "maketoken", user, *asked).strip()
        self.client = httpx.Client(
            base_url=f"{address}/api/v1/{DATASET}", headers={"Authorization": f"Bearer {key}"}, timeout=60
        )

    def get(self, path: str) -> Any:
        return self._checked(self.client.get(path))

    def post(self, path: str, **values: Any) -> Any:
        return self._checked(self.client.post(path, json=values))

    def _checked(self, answer: httpx.Response) -> Any:
        assert answer.is_success, f"{answer.request.url} {answer.status_code} {answer.text[:500]}"
        return answer.json()


@dataclass
class Batch:
    """A batch in a worker's hands, by the REST API that the workbench uses."""

    address: str
    token: str
    seat: str = ""  # the address he came to the batch from
    client: httpx.Client = field(init=False)

    def __post_init__(self) -> None:
        self.client = httpx.Client(
            base_url=f"{self.address}/api/v1/assignment/",
            headers={"Authorization": f"Assignment {self.token}"},
            timeout=60,
        )

    def annotate(self, work: Callable[[int, Rows], Rows], seconds: float) -> None:
        for frame in self._checked(self.client.get("frames/"))["frames"]:
            people = work(frame["number"], frame["annotations"])
            save = {"save_id": str(uuid.uuid4()), "revision": frame["revision"], "annotations": people}
            save |= {"done": True, "nobody": not people, "seconds": seconds}
            self._checked(self.client.put(f"frames/{frame['number']}/", json=save))

    def submit(self) -> str:
        code: str = self._checked(self.client.post("submit/"))["code"]
        return code

    def home(self) -> str:
        """The page he is sent to afterwards."""
        return httpx.get(self.seat, follow_redirects=True, timeout=60).text

    def _checked(self, answer: httpx.Response) -> Any:
        assert answer.is_success, f"{answer.request.url} {answer.status_code} {answer.text[:500]}"
        return answer.json()


def placed(person: int, position: int, origin: str = "clicked") -> dict[str, Any]:
    shape = {"height": None, "radius": None}
    return {"person": person, "position": position, "state": "validated", "origin": origin, **shape}


def careful(frame: int, before: Rows) -> Rows:
    """Everybody within three centimetres of where he stands."""
    return [placed(index + 1, place + frame % 2) for index, place in enumerate(TRUTH[frame])]


def sloppy(frame: int, before: Rows) -> Rows:
    """The last one is overlooked, and the others stand a third of a metre off."""
    places = GRID.nearest(GRID.metres(TRUTH[frame][:-1]) + np.array([0.35, 0.0]))
    return [placed(index + 1, int(place)) for index, place in enumerate(places)]


def pressing_next(frame: int, before: Rows) -> Rows:
    return [{**one, "state": "validated"} for one in before]


def came_by_prolific(address: str, link: str, person: str, submission: str) -> Batch:
    """Prolific fills in the study's address; then two buttons are pressed."""
    for name, value in (("PROLIFIC_PID", person), ("STUDY_ID", "st1"), ("SESSION_ID", submission)):
        link = link.replace(f"{{{{%{name}%}}}}", value)
    with httpx.Client(follow_redirects=True, timeout=60) as browser:
        home = browser.post(link)
        assert "/work/" in str(home.url), home.text
        bench = browser.post(f"{home.url}start/")
        return Batch(address, token_in(str(bench.url)), str(home.url))


def token_in(url: str) -> str:
    found = re.search(r"/annotate/([^/]+)/", url)
    assert found, url
    return found[1]


def somebody(browser: Browser, errors: list[str]) -> Page:
    """A browser of his own."""
    page = browser.new_context(viewport={"width": 1920, "height": 1080}).new_page()
    page.set_default_timeout(30_000)
    page.on("pageerror", lambda error: errors.append(str(error)))
    return page


def log_in(page: Page, address: str, name: str) -> Page:
    page.goto(f"{address}/login/")
    page.get_by_label("User name").fill(name)
    page.get_by_label("Password").fill(PASSWORD)
    page.get_by_role("button", name="Log in").click()
    expect(page.get_by_label("Password")).to_have_count(0)
    return page


def released(folder: Path) -> list[tuple[int, int, int]]:
    """Frame, person and position, as any reader of such files finds them."""
    return [
        (int(path.stem), one["personID"], one["positionID"])
        for path in sorted((folder / "annotations_positions").glob("*.json"))
        for one in json.loads(path.read_text())
    ]


class Story:
    """What everybody in it knows."""

    def __init__(self, site: Site, prolific: Prolific, browser: Browser, address: str) -> None:
        self.site, self.prolific, self.browser, self.address = site, prolific, browser, address
        self.errors: list[str] = []
        self.maria = Script(site, address, "maria", "read", "work")
        self.lena = Script(site, address, "lena", "read", "release")
        self.told: list[str] = []

    def staff(self, name: str) -> Page:
        return log_in(somebody(self.browser, self.errors), self.address, name)

    def link(self, campaign: str, kind: str = "general") -> str:
        found: str = self.maria.post(f"campaigns/{campaign}/links/", kind=kind)["link"]
        return found

    def at(self, page: Page, path: str) -> Page:
        page.goto(f"{self.address}/{DATASET}{path}")
        return page

    def hour_passes(self) -> None:
        """Since batches were taken and saved: the server believes no more time than has passed."""
        self.site.sql("UPDATE gtm_hit_assignment SET leased_at = leased_at - interval '1 hour'")
        self.site.sql("UPDATE gtm_hit_workclock SET seen_at = seen_at - interval '1 hour'")

    def works(self, batch: Batch, how: Any, seconds: float) -> str:
        self.hour_passes()
        batch.annotate(how, seconds)
        return batch.submit()

    def review_of(self, campaign: str, batch: int, copy: int) -> int:
        lists = ("waiting", "returned", "decided", "appeals")
        for name in lists:
            for one in self.maria.get(f"reviews/?list={name}&campaign={campaign}")["results"]:
                if (one["batch"], one["copy"]) == (batch, copy):
                    return int(one["id"])
        raise AssertionError(f"nobody submitted batch {batch}, copy {copy} of {campaign}")


class Worker:
    """The Celery worker; killed like by a power cut, and started again."""

    def __init__(self, site: Site) -> None:
        self.site = site

    def start(self) -> None:
        self.running = self.site.worker()
        self.running.__enter__()

    def kill(self) -> None:
        self.running.__exit__(None, None, None)
