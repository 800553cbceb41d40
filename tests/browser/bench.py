"""A page with the workbench open, as an annotator has it."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from playwright.sync_api import Locator, Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.geometry.camera import Camera as CalibratedCamera
from gtm_hit.geometry.camera import project
from gtm_hit.models import Annotation, Assignment
from tests.browser import street as streets
from tests.browser.street import GRID, Street, workbench_path

TWO_FRAMES = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


class Bench:
    """What a test needs to see and do; everything goes through the page as an annotator has it."""

    def __init__(self, page: Page, server: LiveServer, street: Street, assignment: Assignment) -> None:
        self.page = page
        self.server = server
        self.street = street
        self.assignment = assignment
        self.address = server.url + workbench_path(assignment)

    def open(self) -> Bench:
        self.page.goto(self.address)
        expect(self.page.locator("#workbench")).to_have_attribute("data-ready", "true")
        return self

    def press(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def place_of(self, view: int, position: int) -> tuple[float, float]:
        return place_on_page(self.page, view, position)

    def click(self, view: int, position: int, **options: Any) -> None:
        click_position(self.page, view, position, **options)

    def click_ground(self, person: int, frame: int = 0) -> None:
        """Click on the feet of somebody of the truth, in the view that shows them best."""
        position = int(self.street.truth[frame][person])
        self.click(best_view(position), position)

    def pane(self, view: int) -> Locator:
        return pane_of(self.page, view)

    def painted(self) -> None:
        """Wait until what was done has reached the screen."""
        self.page.evaluate(TWO_FRAMES)

    def rows(self) -> list[str]:
        self.painted()
        return self.page.locator(".people li .number").all_inner_texts()

    def selected(self) -> str | None:
        self.painted()
        chosen = self.page.locator('.people li[aria-selected="true"] .number')
        return chosen.inner_text() if chosen.count() else None

    def saved(self) -> None:
        expect(self.page.locator(".save-words")).to_have_text(re.compile("All saved"))

    def stored(self, frame: int = 0) -> list[Annotation]:
        self.saved()
        return list(
            Annotation.objects.filter(layer=self.assignment.layer, frame=self.street.frames[frame]).order_by(
                "person"
            )
        )


def pane_of(page: Page, view: int) -> Locator:
    return page.locator(f'[data-view="camera-{view}"]')


def place_on_page(page: Page, view: int, position: int, height: float = 0.0) -> tuple[float, float]:
    """Where a position's ground point is, or what is so many metres above it, in an unzoomed view."""
    x, y = GRID.metres([position])[0]
    camera = streets.cameras()[view]
    u, v = project(camera, [[x, y, height]])[0]
    bounds = pane_of(page, view).bounding_box()
    assert bounds is not None
    scale = min(bounds["width"] / camera.width, bounds["height"] / camera.height)
    left = bounds["x"] + (bounds["width"] - camera.width * scale) / 2
    top = bounds["y"] + (bounds["height"] - camera.height * scale) / 2
    return left + u * scale, top + v * scale


def click_position(page: Page, view: int, position: int, **options: Any) -> None:
    page.mouse.click(*place_on_page(page, view, position), **options)


def metres_apart(one: int, other: int) -> float:
    (x1, y1), (x2, y2) = GRID.metres([one, other])
    return float(((x1 - x2) ** 2 + (y1 - y2) ** 2) ** 0.5)


def off_centre(camera: CalibratedCamera, position: int) -> float:
    """Pixels between the image's centre and a position's ground point; infinite near the border."""
    x, y = GRID.metres([position])[0]
    u, v = project(camera, [[x, y, 0.0]])[0]
    if not (100 < u < camera.width - 100 and 100 < v < camera.height - 100):
        return float("inf")
    return float(abs(u - camera.width / 2) + abs(v - camera.height / 2))


def nearness(camera: CalibratedCamera, position: int) -> float:
    """Pixels a patch of ground covers: how exactly a click can place somebody; none near the border."""
    if off_centre(camera, position) == float("inf"):
        return float("-inf")
    x, y = GRID.metres([position])[0]
    foot, beside, behind = project(camera, [[x, y, 0.0], [x + 0.1, y, 0.0], [x, y + 0.1, 0.0]])
    # A low camera sees a step away from it as almost nothing, so the area counts, not the width.
    return float(abs(np.linalg.det([beside - foot, behind - foot])))


def best_view(position: int) -> int:
    return max(streets.cameras(), key=lambda camera: nearness(camera, position)).index


def well_seen(street: Street, frame: int = 0) -> tuple[int, int]:
    """A view and a person of the truth whose feet are near its centre."""
    places = street.truth[frame]
    pairs = [(camera, person) for camera in streets.cameras() for person in range(len(places))]
    camera, person = min(pairs, key=lambda pair: off_centre(pair[0], int(places[pair[1]])))
    return camera.index, person
