"""How many decoded pictures a page keeps, and what it says of those that do not arrive."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.browser.bench import Bench

pytestmark = pytest.mark.browser

MEGABYTE = 1024 * 1024

# A batch of ten frames and seven views; what is alive is counted where it is decoded and closed.
BATCH = """
const { Images } = await import("/static/views/images.js");
const { CameraView } = await import("/static/views/camera_view.js");
const counted = { alive: 0, most: 0 };
const bytes = ({ width, height }) => 4 * width * height;
const decode = window.createImageBitmap;
window.createImageBitmap = async (...parts) => {
  const bitmap = await decode(...parts);
  counted.most = Math.max(counted.most, (counted.alive += bytes(bitmap)));
  return bitmap;
};
const close = ImageBitmap.prototype.close;
ImageBitmap.prototype.close = function () {
  counted.alive -= bytes(this);
  close.call(this);
};
const picture = async (width, height) => {
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  canvas.getContext("2d").fillRect(0, 0, width, height);
  return new Promise((done) => canvas.toBlob(done, "image/jpeg"));
};
const blobs = { light: await picture(960, 540), full: await picture(1920, 1080) };
const numbers = [...Array(10).keys()];
const size = { width: 1920, height: 1080 };
const cameras = [...Array(7).keys()].map((index) => ({ index, name: `C${index}`, ...size }));
const addresses = cameras.map(({ index }) => ({ camera: index, light: "light", full: "full" }));
const frames = numbers.map((number) => ({ number, images: addresses }));
const images = new Images({ blob: async (address) => blobs[address] }, { frames, cameras }, BUDGET);
const views = cameras.map((_, index) => new CameraView({ cameras }, index, images));
const open = (number) => images.want([...numbers.slice(number), ...numbers.slice(0, number).reverse()]);
const paint = (number, scale) => views.map((view) => view.picture(number, { scale }, 1));
const settle = async (fine) => {
  for (let tries = 0; tries < 400 && !fine(); tries += 1) await new Promise((done) => setTimeout(done, 10));
};
const sharp = (number) => paint(number, 1).filter(({ bitmap }) => bitmap?.width === 1920).length;
"""


def looked_through(page: Page, budget: float, body: str) -> Any:
    script = BATCH.replace("BUDGET", str(int(budget * MEGABYTE)))
    return page.evaluate(f"async () => {{ {script} {body} }}")


def test_a_batch_looked_at_close_up_stays_within_the_budget(module_page: Page) -> None:
    most = looked_through(
        module_page,
        256,
        """
        for (const number of numbers) {
          open(number);
          await settle(() => sharp(number) === 7);
        }
        return counted.most;
        """,
    )
    assert most / MEGABYTE <= 256


def test_every_frame_is_sharp_while_it_is_looked_at_close_up(module_page: Page) -> None:
    sharp = looked_through(
        module_page,
        256,
        """
        const seen = [];
        for (const number of numbers) {
          open(number);
          await settle(() => sharp(number) === 7);
          seen.push(sharp(number));
        }
        return seen;
        """,
    )
    assert sharp == [7] * 10


def test_light_pictures_count_and_the_nearest_frames_are_kept(module_page: Page) -> None:
    most, kept = looked_through(
        module_page,
        60,
        """
        open(0);
        await settle(() => numbers.filter((number) => images.peek(number, 6, "light")).length >= 4);
        open(9);
        await settle(() => images.peek(9, 6, "light") && images.peek(7, 6, "light"));
        return [counted.most, [9, 8, 7, 0].map((number) => images.peek(number, 6, "light") !== null)];
        """,
    )
    assert most / MEGABYTE <= 60
    assert kept == [True, True, True, False]


def test_views_too_large_for_the_budget_stay_light_and_nothing_is_fetched_again_and_again(
    module_page: Page,
) -> None:
    most, sharp, light, fetched = looked_through(
        module_page,
        40,
        """
        let fetched = 0;
        const blob = images._api.blob;
        images._api.blob = (address) => { fetched += 1; return blob(address); };
        open(0);
        await settle(() => images.peek(0, 6, "light"));
        await settle(() => sharp(0) === 7 || counted.alive > 36_000_000);
        const before = fetched;
        for (let tries = 0; tries < 20; tries += 1) {
          sharp(0);
          await new Promise((done) => setTimeout(done, 5));
        }
        const shown = paint(0, 1).map(({ bitmap }) => bitmap?.width);
        const count = (width) => shown.filter((one) => one === width).length;
        return [counted.most, count(1920), count(960), fetched - before];
        """,
    )
    assert most / MEGABYTE <= 40
    assert sharp >= 2 and sharp + light == 7
    assert fetched == 0


@pytest.mark.django_db(transaction=True)
def test_a_picture_that_finds_no_connection_says_so(bench: Callable[..., Bench]) -> None:
    opened = bench()
    opened.page.route("**/api/v1/images/**", lambda route: route.abort("internetdisconnected"))
    opened.open()
    expect(opened.pane(0).locator(".pane-note")).to_have_text(
        "The image did not arrive: the server does not answer"
    )


@pytest.mark.django_db(transaction=True)
def test_a_page_that_finds_no_connection_when_it_opens_says_so(bench: Callable[..., Bench]) -> None:
    opened = bench()
    opened.page.route("**/scene/", lambda route: route.abort("internetdisconnected"))
    opened.page.goto(opened.address)
    expect(opened.page.get_by_role("alert")).to_contain_text("the server does not answer")
