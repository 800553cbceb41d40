"""Two scripted annotators who do a batch at the real workbench. What each of them goes by is all they know.

`Checker` has proposals and looks only at the screen: what is dashed, what is counted, what the words at the
pointer say. Nothing asks for the truth. `Clicker` has none and sees feet in the pictures as a human eye does:
the truth is asked where they are, even where somebody hides them, and a hand as sure as if every view were
zoomed in clicks on them. Every key, click and pointing counts.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from playwright.sync_api import Page, expect

from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.camera import Camera, project
from tests.browser.eyes import Eyes, Mark

# No Django here: the benchmark has its server in another process.
CAMERAS = load_cameras(Path(__file__).resolve().parents[2] / "fixtures" / "wildtrack_cameras.json")
GRID = read_scene().grid
MISS = 1.0  # CSS pixels, standard deviation of a click along each axis
TRIES = 3  # at one person's feet
RIGHT = 0.15  # metres from the feet as the eye sees them: nearer is right
VIEWS = 2  # that must show somebody before a doubtful proposal is believed
STEP = 4  # positions beside somebody, by which the ground's scale in a view is measured
EDGE = 4  # pixels from a picture's border
PATIENCE = 40  # doubtful ones in a frame
# The keystroke-level model: seconds of a key, a click, pointing at something, and making up one's mind.
KEY, CLICK, POINT, MIND = 0.28, 0.2, 1.1, 1.35


@dataclass
class Hands:
    """Does what it is told and counts it."""

    page: Page
    counts: Counter[str] = field(default_factory=Counter)

    def key(self, chord: str) -> None:
        self.counts["keys"] += 1
        self.page.keyboard.press(chord)

    def point(self, x: float, y: float) -> None:
        self.counts["pointings"] += 1
        self.page.mouse.move(x, y)

    def click(self, x: float, y: float, button: str = "left", shift: bool = False) -> None:
        self.counts["clicks"] += 1
        if shift:
            self.page.keyboard.down("Shift")
        self.page.mouse.click(x, y, button="right" if button == "right" else "left")
        if shift:
            self.page.keyboard.up("Shift")

    def decide(self) -> None:
        """No action, but it takes time."""
        self.counts["decisions"] += 1

    @property
    def actions(self) -> int:
        return sum(count for kind, count in self.counts.items() if kind != "decisions")

    @property
    def human_seconds(self) -> float:
        """By the keystroke-level model."""
        keys, clicks = self.counts["keys"] * KEY, self.counts["clicks"] * (POINT + CLICK)
        return keys + clicks + self.counts["pointings"] * POINT + self.counts["decisions"] * MIND


class Annotator:
    def __init__(self, page: Page, frames: int) -> None:
        self.page, self.frames = page, frames
        self.eyes, self.hands = Eyes.on(page), Hands(page)

    def open(self, address: str) -> None:
        self.page.goto(address)
        expect(self.page.locator("#workbench")).to_have_attribute("data-ready", "true")

    def do_batch(self) -> None:
        for index in range(self.frames):
            expect(self.page.locator(".place")).to_have_text(f"Frame {index + 1} of {self.frames}")
            self.do_frame(index)
            self.hands.key("n")
        dialog = self.page.get_by_role("dialog")
        expect(dialog).to_contain_text(f"All {self.frames} frames are done")
        button = dialog.get_by_role("button", name="Submit").bounding_box()
        assert button is not None
        self.hands.click(button["x"] + button["width"] / 2, button["y"] + button["height"] / 2)
        expect(dialog).to_have_count(0)

    def do_frame(self, index: int) -> None:
        raise NotImplementedError

    def validate_yellow(self) -> None:
        """Everybody who came along from the frame before stays."""
        self.eyes.marks()  # what was done before is on the screen
        if re.search(r"[1-9]\d* yellow", self.page.locator(".left").inner_text()):
            self.hands.decide()
            self.hands.key("Shift+Enter")


class Checker(Annotator):
    def open(self, address: str) -> None:
        super().open(address)
        expect(self.page.locator(".proposals .details").first).not_to_have_text("")

    def do_frame(self, index: int) -> None:
        likely, _doubtful = self.counted()
        if likely:
            self.hands.decide()
            self.hands.key("o")
        for _ in range(PATIENCE):
            if not self.counted()[1]:
                return self.validate_yellow()
            self.settle(self.eyes.proposals())
        raise AssertionError("doubtful proposals do not become fewer")

    def counted(self) -> tuple[int, int]:
        """To accept and doubtful, as the panel says."""
        self.eyes.marks()
        words = self.page.locator(".proposals .details").first.inner_text()
        found = re.match(r"Proposed: (\d+) to accept, (\d+) doubtful", words)
        return (int(found[1]), int(found[2])) if found else (0, 0)

    def settle(self, shown: Sequence[Mark]) -> None:
        """Of the doubtful ones that are left: pointed at where it is largest, read, and decided."""
        if not shown:  # no view shows the place
            self.hands.key("Shift+f")
            return self.hands.key("Shift+r")
        self.hands.point(*max(shown, key=lambda mark: mark.height).middle)
        self.hands.decide()
        self.hands.key("Shift+o" if believed(self.eyes.words()) else "Shift+r")


def believed(words: Sequence[str]) -> bool:
    """Two views show somebody, or the frames before and after do."""
    views = [
        words_of.split(" in ", 1)[1].split(", ")
        for words_of in words
        if words_of.startswith(("found in", "differs from the background in"))
    ]
    return sum(map(len, views)) >= VIEWS or any(each.startswith("seen before and after") for each in words)


class Pane:
    """Where the ground is on the page, in a view that shows its whole picture."""

    def __init__(self, page: Page, camera: Camera) -> None:
        self.camera = camera
        bounds = page.locator(f'[data-view="camera-{camera.index}"]').bounding_box()
        assert bounds is not None
        self.ratio = min(bounds["width"] / camera.width, bounds["height"] / camera.height)
        middle = (bounds["x"] + bounds["width"] / 2, bounds["y"] + bounds["height"] / 2)
        self.corner = np.array(middle) - np.array((camera.width, camera.height)) * self.ratio / 2

    def pixel_of(self, position: int) -> np.ndarray:
        return project(self.camera, [[*GRID.metres([position])[0], 0.0]])[0]

    def place_of(self, position: int) -> np.ndarray:
        """CSS pixels of the page."""
        return self.corner + self.ratio * self.pixel_of(position)

    def shows(self, position: int) -> bool:
        (u, v), camera = self.pixel_of(position), self.camera
        return bool(EDGE < u < camera.width - EDGE and EDGE < v < camera.height - EDGE)

    def scale(self, position: int) -> np.ndarray:
        """CSS pixels per metre (2, 2) on the ground there."""
        beside = (position, position + STEP, position + STEP * GRID.columns)
        foot, east, north = (self.place_of(place) for place in beside)
        return np.column_stack((east - foot, north - foot)) / (STEP * GRID.step)


@dataclass(frozen=True)
class Feet:
    """One person of the truth in one frame."""

    person: int
    position: int


class Clicker(Annotator):
    def __init__(self, page: Page, truth: Sequence[Sequence[Feet]], seed: int = 1) -> None:
        super().__init__(page, len(truth))
        self.truth = truth
        self.panes: dict[int, Pane] = {}
        self.random = np.random.default_rng(seed)
        self.number: dict[int, int] = {}  # at the workbench, of people of the truth

    def open(self, address: str) -> None:
        super().open(address)
        self.panes = {camera.index: Pane(self.page, camera) for camera in CAMERAS}

    def do_frame(self, index: int) -> None:
        marked = self.eyes.people()
        here = {feet.person: feet for feet in self.truth[index]}
        for person, number in list(self.number.items()):
            if number in marked and person not in here:
                self.remove(number)
                del self.number[person]
        for feet in here.values():
            if not self.views(feet):
                continue  # nobody sees those feet
            boxes = marked.get(self.number.get(feet.person, -1), [])
            if not boxes:
                self.place(feet)
            elif self.is_off(feet, boxes):
                self.choose(self.number[feet.person])
                self.move(feet)
        self.validate_yellow()

    def place(self, feet: Feet) -> None:
        self.hands.decide()
        self.hands.click(*self.aim(feet), shift=True)
        self.eyes.marks()
        chosen = self.page.locator('.people li[aria-selected="true"] .number')
        if chosen.count():
            self.number[feet.person] = int(chosen.inner_text())
            self.move(feet, TRIES - 1)

    def move(self, feet: Feet, tries: int = TRIES) -> None:
        """Who is selected, until the box stands on the feet."""
        for _ in range(tries):
            boxes = self.eyes.people().get(self.number[feet.person], [])
            if not self.is_off(feet, boxes):
                return
            self.hands.click(*self.aim(feet), button="right")

    def remove(self, number: int) -> None:
        self.choose(number)
        self.hands.key("Backspace")

    def choose(self, number: int) -> None:
        self.hands.decide()
        row = self.page.locator(f"#person-{number}")
        row.scroll_into_view_if_needed()
        bounds = row.bounding_box()
        assert bounds is not None
        self.hands.click(bounds["x"] + bounds["width"] / 2, bounds["y"] + bounds["height"] / 2)

    def aim(self, feet: Feet) -> tuple[float, float]:
        at = self.panes[self.views(feet)[0]].place_of(feet.position)
        x, y = at + self.random.normal(0, MISS, 2)
        return float(x), float(y)

    def views(self, feet: Feet) -> list[int]:
        """Those that show the feet, the one first in which a click places best."""
        seen = [view for view, pane in self.panes.items() if pane.shows(feet.position)]
        return sorted(seen, key=lambda view: -np.linalg.svd(self.panes[view].scale(feet.position))[1].min())

    def is_off(self, feet: Feet, boxes: Sequence[Mark]) -> bool:
        """Whether somebody's box does not stand on the feet, in the view where that shows best."""
        box_in = {box.view: box for box in boxes}
        seen = [view for view in self.views(feet) if view in box_in]
        if not seen:
            return False
        pane, position = self.panes[seen[0]], feet.position
        away = np.linalg.solve(pane.scale(position), box_in[seen[0]].foot - pane.place_of(position))
        return bool(np.hypot(*away) > RIGHT)
