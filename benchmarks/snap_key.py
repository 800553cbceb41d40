"""From a key to somebody who stands where the views show them: `python -m benchmarks.snap_key`.

The first frame of the demo scene at the real workbench in Chromium, its proposals accepted. One person after
the other is moved 30 cm aside by arrow keys and put right by Shift+D; what counts is the time from that key
to the frame painted with the new place. Needs the detector (`make detector`).
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
from pathlib import Path
from statistics import median, quantiles

from playwright.sync_api import Browser, Page, TimeoutError, sync_playwright

from benchmarks.checking import SEED
from benchmarks.workbench import ALL_VIEWS, CHROMIUM, ROOT, SCREEN, server
from gtm_hit.vision import detectors

FRAMES = 5  # the fewest of which a background is learned
STEPS = 12  # of 2.5 cm
LONGEST = 3000  # milliseconds
TIMER = """
() => {
  window.taken = [];
  document.addEventListener("keydown", (event) => {
    if (!(event.shiftKey && event.code === "KeyD")) return;
    const start = performance.now();
    const before = document.querySelector(".details").textContent;
    const look = () => {
      if (performance.now() - start > LONGEST) return;
      if (document.querySelector(".details").textContent === before) return requestAnimationFrame(look);
      requestAnimationFrame(() => window.taken.push(performance.now() - start));
    };
    requestAnimationFrame(look);
  }, true);
}
""".replace("LONGEST", str(LONGEST))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--detector", type=Path, default=detectors.built_in_path(ROOT / "var"))
    options = parser.parse_args()
    if not options.detector.is_file():
        raise SystemExit("No detector (make detector): there is nothing to snap to.")
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder, sync_playwright() as playwright:
        kept = detectors.built_in_path(Path(folder))
        kept.parent.mkdir()
        shutil.copy(options.detector, kept)
        with server(Path(folder), SEED.replace("FRAMES", str(FRAMES))) as (address, made):
            browser = playwright.chromium.launch(
                executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"]
            )
            taken, people = measured(browser, address + made["checker"][0])
            browser.close()
    print(f"{len(taken)} of {people} people moved")
    print(f"key → moved: median {median(taken):.0f} ms, p95 {quantiles(taken, n=20)[-1]:.0f} ms")


def measured(browser: Browser, address: str) -> tuple[list[float], int]:
    page = browser.new_context(viewport=SCREEN).new_page()
    page.goto(address)
    page.wait_for_selector("[data-ready]")
    page.wait_for_function(ALL_VIEWS)
    page.wait_for_load_state("networkidle")
    page.keyboard.press("o")
    page.wait_for_timeout(1000)
    page.evaluate(TIMER)
    people = set()
    while (person := selected(page)) not in people:
        people.add(person)
        for _ in range(STEPS):
            page.keyboard.press("ArrowRight")
        page.wait_for_timeout(1000)  # until what was moved is saved, as when a hand changes keys
        before = page.evaluate("window.taken.length")
        page.keyboard.press("Shift+D")
        try:
            page.wait_for_function(f"() => window.taken.length > {before}", timeout=LONGEST)
        except TimeoutError:
            continue  # somebody who stays where they are
    taken: list[float] = page.evaluate("window.taken")
    page.context.close()
    return taken, len(people)


def selected(page: Page) -> str:
    """Of the next person: what the panel calls them."""
    page.keyboard.press("Tab")
    page.wait_for_timeout(50)
    name: str = page.evaluate("document.querySelector('.details').textContent.match(/\\d+/)[0]")
    return name


if __name__ == "__main__":
    main()
