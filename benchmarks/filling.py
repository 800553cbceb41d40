"""How near boxes filled in between keyframes come to real people: `python -m benchmarks.filling`.

Every second, third … frame of the real positions (../shared/data/wildtrack) is a keyframe; the workbench's
own keyframes.js, in Chromium, fills in the frames between. A share means little without the people it is of,
so three are printed: of those filled in (the same identity in the keyframes on both sides), of everybody in
the frames between (who comes or goes there has no box), and of everybody in all frames, the keyframes' people
counted as right. Identities depend on how far people are believed to walk in half a second: the bolder the
linking, the more mistaken identities are filled in between; the more cautious, the fewer people.
"""

from __future__ import annotations

import sys
from typing import Any

from playwright.sync_api import Page, sync_playwright

from benchmarks.effort import ADDRESS, CHROMIUM, POSITIONS, answer, linked, read_frames, scene

LINKS = (2.5, 2.0, 1.6, 1.5)  # m/s; who would have to be faster is somebody else
STEPS = (2, 3, 5)


def main() -> None:
    if not POSITIONS.exists():
        sys.exit(f"{POSITIONS} is not there")
    positions = read_frames(POSITIONS)
    print(f"{'% within 10 cm of the truth':<27}{'linked up to':>13}{'filled in':>11}{'between':>9}", end="")
    print(f"{'of filled':>11}{'of between':>12}{'of all, with keyframes':>24}")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        page = browser.new_page()
        page.route(ADDRESS + "**", answer)
        page.goto(ADDRESS)
        for step in STEPS:
            for fastest in LINKS:
                print_row(step, fastest, measure(page, linked(positions, fastest), step))
        browser.close()


def measure(page: Page, frames: list[dict[int, int]], step: int) -> dict[str, Any]:
    """Counts of people: `filled`, `near`, `between`, `keyed`, added up over every frame to begin with."""
    job = {"scene": scene(len(frames)), "truth": frames, "step": step}
    counts: dict[str, Any] = page.evaluate(
        "async (job) => (await import('/benchmarks/filling.js')).measure(job)", job
    )
    return counts


def print_row(step: int, fastest: float, counts: dict[str, Any]) -> None:
    filled, near, between, keyed = (counts[name] for name in ("filled", "near", "between", "keyed"))
    shares = (near / filled, near / between, (near + keyed) / (between + keyed))
    first, second, third = (f"{100 * share:.1f}" for share in shares)
    name = {2: "every second frame", 3: "every third frame"}.get(step, f"every {step}th frame")
    print(f"{name:<27}{fastest:>9.1f} m/s{filled:>11}{between:>9}", end="")
    print(f"{first:>11}{second:>12}{third:>24}", flush=True)


if __name__ == "__main__":
    main()
