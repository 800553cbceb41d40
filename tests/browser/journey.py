"""Somebody who calibrates: a hand whose clicks are counted and miss a little, and the steps she goes."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from playwright.sync_api import Locator, Page, expect

from gtm_hit.geometry.camera import Camera
from tests.browser import journey_scene as scene
from tests.browser.journey_scene import Belongings
from tests.browser.test_desk_check import CLOSER
from tests.browser.test_desk_check import TO_CLIENT as TO_PANE
from tests.browser.test_desk_ground import TO_CLIENT

SIGMA = 0.5  # pixels of the picture by which a click misses the mark, each way
SHARP = 0.75  # pixels between mark and ghost that an eye sees under the magnifier
SIZES = ((1280, 800), (1920, 1080))
SHOTS = os.environ.get("JOURNEY_SHOTS", "")  # a folder for pictures of every step
FIRST = 4
MOST_VIEWS = 3  # in which the same thing is clicked


@dataclass
class Hand:
    """All that is pressed, clicked, chosen and typed, counted."""

    page: Page
    touches: int = 0
    seconds: dict[str, float] = field(default_factory=dict)
    _rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(20))

    def press(self, key: str) -> None:
        self.touches += 1
        self.page.keyboard.press(key)

    def click(self, target: Locator) -> None:
        self.touches += 1
        target.click()

    def send(self, name: str, file: Path, root: Locator | None = None) -> None:
        """A click for the dialog, and one for the file in it."""
        self.touches += 2
        (root or self.page.locator("main")).locator(f"input[type=file][name={name}]").set_input_files(file)

    def choose(self, name: str, value: str) -> None:
        self.touches += 2
        self.page.locator(f"select[name={name}]").select_option(value)

    def type(self, name: str, text: str) -> None:
        """A click into the field and every letter."""
        self.touches += 1 + len(text)
        self.page.locator(f"main input[name={name}]").fill(text)

    def point_at(self, pixel: tuple[float, float]) -> None:
        """A click at a pixel of the picture, as near as a hand gets and a mouse can tell."""
        self.touches += 1
        x, y = self.page.evaluate(TO_CLIENT, self.missing(pixel))
        self.page.mouse.click(round(x), round(y))

    def missing(self, pixel: tuple[float, float]) -> list[float]:
        """Where a hand that wants it clicks."""
        return (np.array(pixel) + self._rng.normal(0, SIGMA, 2)).tolist()

    @contextmanager
    def step(self, name: str) -> Iterator[None]:
        start = time.perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start

    def shoot(self, name: str) -> None:
        if not SHOTS:
            return
        before = self.page.viewport_size
        for width, height in SIZES:
            self.page.set_viewport_size({"width": width, "height": height})
            self.page.wait_for_timeout(200)
            self.page.screenshot(path=Path(SHOTS) / f"{name}-{width}.png")
        if before:
            self.page.set_viewport_size(before)


def new_desk(hand: Hand, address: str) -> None:
    page = hand.page
    page.goto(f"{address}/calibration-desks/")
    hand.shoot("01-desks")
    hand.type("slug", "plaza")
    hand.type("cameras", "C1 C2 C3 C4 C5 C6 C7")
    hand.click(page.get_by_role("button", name="Begin"))
    expect(page.get_by_role("heading", name="Next:")).to_contain_text("Find the lens of C1")
    hand.shoot("02-new-desk")


def find_lens(hand: Hand, camera: Camera, files: Belongings) -> None:
    """From the page that says what is next; the board is said for the first camera only."""
    page = hand.page
    expect(page.locator("h1 + nav")).to_be_visible()
    if camera.index == 0:
        hand.shoot("03-lens-empty")
        hand.choose("kind", "chessboard")
        hand.type("spacing", str(round(1000 * scene.BOARD.spacing)))
    expect(page.locator("[name=columns]")).to_have_value(str(scene.BOARD.columns))
    assert float(page.locator("[name=spacing]").input_value()) == 1000 * scene.BOARD.spacing
    hand.send("file", files.videos[camera.name], page.locator("form:has([name=kind])"))
    hand.click(page.get_by_role("button", name="Find the board and solve"))
    if camera.index == 0:
        expect(page.locator("progress[data-job-progress]")).to_be_visible()
        hand.shoot("04-lens-running")
    # C6 looks a sixth beside its middle, as the real one does: usable, as the page says.
    verdict = page.locator(".desk-lens .verdict:is(.is-good, .is-usable)")
    expect(verdict).to_be_visible(timeout=90_000)
    if camera.index == 0:
        hand.shoot("05-lens-good")


def click_ground(hand: Hand, camera: Camera) -> None:
    """Four marks by the mouse, far apart; the others where they are expected, unless that looks wrong."""
    page, places = hand.page, scene.seen(camera, scene.marks())
    for count, name in enumerate(_spread(places), start=1):
        hand.click(page.locator(f"tr[data-point={name}]"))
        hand.point_at(places[name])
        expect(page.locator(".desk-picture .clicked")).to_have_count(count)
    expect(page.locator(".desk-picture .expected").first).to_be_attached()
    saved(page)
    if camera.index == 0:
        hand.shoot("08-ground-four")
    while (left := page.locator(".desk-picture .expected").count()) > 0:
        _next_mark(hand, places)
        expect(page.locator(".desk-picture .expected")).not_to_have_count(left)
        saved(page)


def _next_mark(hand: Hand, places: dict[str, tuple[float, float]]) -> None:
    page = hand.page
    name = page.locator("[data-now]").inner_text()
    ghost = page.evaluate(GHOST, name)
    assert ghost is not None, f"{name} is asked for and not expected in the picture"
    if name not in places or np.hypot(*np.subtract(ghost, places[name])) <= SHARP:
        hand.press("Enter")
    else:
        hand.point_at(places[name])


GHOST = """name => {
    const node = document.querySelector(`.desk-picture .expected[data-point="${name}"]`);
    if (!node) return null;
    const box = node.getBBox();
    return [box.x + box.width / 2, box.y + box.height / 2];
}"""


def _spread(places: dict[str, tuple[float, float]]) -> list[str]:
    """The four that are farthest from each other, as an eye would choose them."""
    names, pixels = list(places), np.array(list(places.values()))
    chosen = [int(np.argmin(pixels.sum(axis=1)))]
    while len(chosen) < FIRST:
        away = np.linalg.norm(pixels[:, None] - pixels[chosen][None], axis=2).min(axis=1)
        chosen.append(int(np.argmax(away)))
    return [names[index] for index in chosen]


def saved(page: Page) -> None:
    expect(page.locator("[data-saved]")).to_have_text("Everything is saved")


def go_there(hand: Hand) -> None:
    """The one next step."""
    hand.click(hand.page.get_by_role("link", name=re.compile("^Go there|^Next: ")))


def bring_points(hand: Hand, files: Belongings) -> None:
    page = hand.page
    hand.shoot("06-ground-empty")
    form = page.locator("form[action$='/ground/points/']")
    hand.send("file", files.points, form)
    hand.click(form.get_by_role("button", name="Take these points"))
    expect(page.locator("tr[data-point]")).to_have_count(len(scene.marks()))


def bring_picture(hand: Hand, camera: Camera, files: Belongings) -> None:
    page = hand.page
    hand.click(page.locator("[data-cameras] button", has_text=camera.name))
    form = page.locator("form[action$='/ground/picture/']")
    if not form.is_visible():
        hand.click(page.locator("summary", has_text="out of files"))
    hand.send("file", files.grounds[camera.name], form)
    hand.click(form.get_by_role("button", name="Use this picture"))
    expect(page.locator("[data-ground]")).to_have_attribute("data-camera", camera.name)
    expect(page.locator(".desk-picture image")).to_have_attribute("href", re.compile(r"\.(jpg|webp|png)"))
    expect(page.locator("[data-empty]")).to_be_hidden()
    if camera.index == 0:
        hand.shoot("07-ground-picture")


def check_and_keep(hand: Hand) -> None:
    """Things that nobody measured, each in three views, kept to be adjusted with."""
    page = hand.page
    hand.click(page.get_by_role("link", name="Check", exact=True))
    expect(page.locator(".pane")).to_have_count(len(scene.cameras()))
    places = {camera.name: scene.seen(camera, scene.tops()) for camera in scene.cameras()}
    for number, thing in enumerate(scene.tops(), start=1):
        views = [name for name, seen in places.items() if thing in seen]
        for name in views[:MOST_VIEWS]:
            _click_closely(hand, name, places[name][thing])
        if number == 1:
            hand.shoot("09a-check")
        hand.press("k")
        expect(page.locator("tr[data-point]")).to_have_count(number)
        saved(page)
        hand.press("f")
    hand.shoot("09b-check-kept")


def _click_closely(hand: Hand, camera: str, pixel: tuple[float, float]) -> None:
    """A turn of the wheel first, as the picture is small."""
    page, pane = hand.page, hand.page.locator(f".pane[data-camera={camera}]")
    aim = [camera, *pixel]
    page.mouse.move(*page.evaluate(TO_PANE, aim))
    page.mouse.wheel(0, -1000)
    page.wait_for_function(CLOSER, arg=[camera, scene.WIDTH / 2])
    hand.touches += 2  # the wheel and the click
    x, y = page.evaluate(TO_PANE, [camera, *hand.missing(pixel)])
    page.mouse.click(round(x), round(y))
    expect(pane.locator(".seen-click")).to_be_attached()


def adjust(hand: Hand) -> None:
    page = hand.page
    hand.click(page.get_by_role("link", name="Adjust", exact=True))
    hand.click(page.get_by_role("button", name="Adjust", exact=True))
    expect(page.get_by_role("heading", name="Result 1")).to_be_visible(timeout=60_000)
    hand.shoot("09c-adjusted")
    hand.click(page.get_by_role("button", name="Use this result"))
    expect(page.get_by_text("The cameras stand by result 1")).to_be_visible()


def import_dataset(hand: Hand, files: Belongings) -> None:
    page = hand.page
    hand.click(page.get_by_role("link", name="Overview"))
    hand.shoot("10-overview-ready")
    go_there(hand)
    hand.shoot("11-place")
    hand.click(page.get_by_role("link", name="Choose the pictures"))
    hand.send("archive", files.frames)
    hand.type("slug", "plaza")
    hand.choose("preset", "wildtrack")
    hand.shoot("12-import")
    hand.click(page.get_by_role("button", name="Import"))
    state = page.locator("[data-job-state], .state").first
    expect(state).to_have_text(re.compile("^(done|failed)$"), timeout=60_000)
    assert state.inner_text() == "done", page.locator("main").inner_text()
    hand.shoot("13-imported")
