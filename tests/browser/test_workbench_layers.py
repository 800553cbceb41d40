"""A long layer, of which only a piece is loaded, edited by two staff members at once."""

from __future__ import annotations

import re
import uuid
from collections.abc import Callable

import pytest
from django.contrib.auth import get_user_model
from django.test import Client
from playwright.sync_api import Browser, Page, expect
from pytest_django.live_server_helper import LiveServer

from gtm_hit.models import Annotation, Frame, Layer, Save
from gtm_hit.ops.frames.saving import save_frame
from tests.browser.street import FRAME_STEP, GRID, make_street

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

FRAMES = 60


@pytest.fixture
def layer(live_server: LiveServer) -> Layer:
    """Persons 1 and 2 standing in every one of many frames; only the first ones have pictures."""
    dataset = make_street(people=1, frames=1).dataset
    frames = [Frame(dataset=dataset, number=FRAME_STEP * index) for index in range(1, FRAMES)]
    Frame.objects.bulk_create(frames)
    made = Layer.objects.create(dataset=dataset, name="truth", kind=Layer.Kind.GROUND_TRUTH)
    author = get_user_model().objects.create_user("importer", is_superuser=True)
    rows = [{"person": person, "position": int(GRID.nearest([[3.0 + person, 9.0]])[0])} for person in (1, 2)]
    for frame in Frame.objects.filter(dataset=dataset):
        save_frame(made, frame, author, uuid.uuid4(), 0, rows)
    return made


@pytest.fixture
def staff(browser: Browser, live_server: LiveServer, layer: Layer) -> Callable[[str], Page]:
    """Open the layer's workbench in a browser of their own."""

    def open_as(name: str) -> Page:
        user = get_user_model().objects.create_superuser(name)
        client = Client()
        client.force_login(user)
        context = browser.new_context(viewport={"width": 1920, "height": 1080})
        cookie = client.cookies["sessionid"]
        context.add_cookies([{"name": "sessionid", "value": cookie.value, "url": live_server.url}])
        page = context.new_page()
        page.goto(f"{live_server.url}/datasets/{layer.dataset.slug}/layers/{layer.name}/")
        expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
        return page

    return open_as


def test_who_is_who_reaches_frames_that_are_not_loaded(layer: Layer, staff: Callable[[str], Page]) -> None:
    page = staff("anna")
    page.keyboard.press("Tab")
    page.keyboard.press("r")
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("New number").fill("7")
    expect(dialog.locator(".change-list")).to_have_text(f"Frames 1–{FRAMES}: 1 becomes 7")
    dialog.get_by_role("button", name="Rename").click()
    expect(page.locator(".save-words")).to_have_text("All saved · r2")
    assert frames_with(layer, 1) == 0
    assert frames_with(layer, 7) == FRAMES
    page.reload()
    expect(page.locator("#workbench")).to_have_attribute("data-ready", "true")
    page.keyboard.press("Control+z")
    expect(page.locator(".notices")).to_have_text("Undone: rename person 1 to 7")
    expect(page.locator(".save-words")).to_have_text("All saved · r3")
    assert frames_with(layer, 1) == FRAMES
    assert frames_with(layer, 7) == 0


def test_two_authors_are_put_together_and_both_stand_in_the_history(
    layer: Layer, staff: Callable[[str], Page]
) -> None:
    anna, ben = staff("anna"), staff("ben")
    for key in ["Tab", "ArrowLeft"]:
        anna.keyboard.press(key)
    expect(anna.locator(".save-words")).to_have_text("All saved · r2")
    for key in ["Tab", "Tab", "ArrowLeft"]:
        ben.keyboard.press(key)
    expect(ben.locator(".save-words")).to_have_text("All saved · r3")
    saves = Save.objects.filter(layer_frame__layer=layer, layer_frame__frame__number=0).order_by("revision")
    first, second, third = (save.annotations for save in saves)
    assert third[0] == second[0] != first[0], "anna's edit stands"
    assert third[1] != first[1], "and ben's too"
    ben.keyboard.press("Shift+H")
    expect(ben.locator(".revision .author")).to_have_text(["ben", "anna", "importer"])


def test_the_same_person_moved_by_two_authors_is_a_question_with_a_name(
    layer: Layer, staff: Callable[[str], Page]
) -> None:
    anna, ben = staff("anna"), staff("ben")
    for page, key in [(anna, "ArrowLeft"), (ben, "ArrowRight")]:
        page.keyboard.press("Tab")
        page.keyboard.press(key)
        if page is anna:
            expect(anna.locator(".save-words")).to_have_text("All saved · r2")
    dialog = ben.get_by_role("dialog")
    expect(dialog).to_contain_text(re.compile("the other, by anna at"))
    dialog.get_by_role("button", name="Use these").click()
    expect(ben.locator(".save-words")).to_have_text("All saved · r3")
    authors = Save.objects.filter(layer_frame__layer=layer, layer_frame__frame__number=0)
    assert [save.user.username for save in authors.order_by("revision") if save.user] == [
        "importer",
        "anna",
        "ben",
    ]


def frames_with(layer: Layer, person: int) -> int:
    return Annotation.objects.filter(layer=layer, person=person).count()
