"""How many actions a person and frame takes at the workbench: `python -m benchmarks.effort [frames [plan]]`.

A plan is named by a part of its name; all of them run unless one is named.

A scripted annotator (effort.js) annotates real people, the positions of ../shared/data/wildtrack, at the
real workbench in Chromium, until everybody is within 5 cm of the truth and validated. It decides perfectly;
every key press and every click counts. Its clicks miss by 3 CSS pixels along each axis (normal) and by the
one image pixel that no zoom makes visible, in the view where that matters least.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Sequence
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Browser, Route, ViewportSize, sync_playwright

from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import HEIGHTS, RADII, FootRule
from gtm_hit.geometry.grid import Grid

ROOT = Path(__file__).resolve().parent.parent
POSITIONS = ROOT.parent / "shared" / "data" / "wildtrack" / "positions_0000-0995.txt"
CHROMIUM = "/usr/bin/chromium"
ADDRESS = "http://workbench.test/"
SCREEN: ViewportSize = {"width": 1920, "height": 1080}
GRID = Grid(columns=480, rows=1440, step=0.025, origin_x=-3.0, origin_y=-9.0)
FRAME_STEP, SECONDS = 5, 0.5
FASTEST = 2.5  # m/s; a longer way than that is somebody else
SEED = 11
# As the built-in detector and the background give them on MultiviewX; scores are made up.
SPREAD, MISSED, FALSE = 0.036, 0.01, 0.01  # metres along each axis, shares
TYPES = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
PAGE = """<!doctype html><link rel="stylesheet" href="/static/workbench/workbench.css">
<link rel="stylesheet" href="/static/workbench/frames/time.css"><div id="workbench"></div>"""

PLANS: dict[str, dict[str, Any]] = {
    "copies, arrow keys (the original's way)": {"copies": True},
    "predicted, arrow keys": {},
    "predicted, arrow keys with Shift": {"far": True},
    "predicted, right clicks, arrow keys with Shift": {"far": True, "clicks": True},
    "… zoomed to the person": {"far": True, "clicks": True, "zoom": True},
    "one by one, close up": {"far": True, "clicks": True, "round": True},
    "… whoever stands right validated together": {"far": True, "clicks": True, "round": True, "skip": True},
    "… every second frame first, filled in": {
        "far": True,
        "clicks": True,
        "round": True,
        "skip": True,
        "keyframes": 2,
    },
    "… every third frame first, filled in": {
        "far": True,
        "clicks": True,
        "round": True,
        "skip": True,
        "keyframes": 3,
    },
    "proposals 4.5 cm off accepted, the others mended": {"far": True, "clicks": True, "proposals": True},
    "one by one, clicks that miss by 3 image pixels, too": {
        "far": True,
        "clicks": True,
        "round": True,
        "skip": True,
        "imagePixels": 3,
    },
}


def main() -> None:
    if not POSITIONS.exists():
        sys.exit(f"{POSITIONS} is not there")
    count = int(sys.argv[1]) if len(sys.argv) > 1 else None
    frames = linked(read_frames(POSITIONS))[:count]
    print(f"{len(frames)} frames, {sum(map(len, frames))} people\n")
    print(f"{'actions per person and frame':<52}{'all':>6}{'arrows':>8}{'keys':>6}{'clicks':>8}")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        for name, plan in PLANS.items():
            if len(sys.argv) > 2 and sys.argv[2] not in name:
                continue
            print_row(name, annotate(browser, frames, plan))
        browser.close()


def print_row(name: str, report: dict[str, Any]) -> None:
    """A line of the table; who goes by the eye is told how many it was right about."""
    if report["wrong"]:
        sys.exit(f"{name}: not annotated: {report['wrong'][:5]}")
    kinds = [report["counts"].get(kind, 0) for kind in ("arrow keys", "other keys", "clicks")]
    arrows, keys, clicks = (actions / report["persons"] for actions in kinds)
    near = f"   {100 * report['near']:.0f} % right" if report.get("near", 1) < 1 else ""
    print(
        f"{name:<52}{arrows + keys + clicks:>6.2f}{arrows:>8.2f}{keys:>6.2f}{clicks:>8.2f}{near}", flush=True
    )


def read_frames(path: Path) -> list[list[int]]:
    """Positions of every frame, in the order of the frames."""
    frames: dict[int, list[int]] = defaultdict(list)
    for line in path.read_text().splitlines():
        number, column, row = map(int, line.split())
        frames[number].append(row * GRID.columns + column)
    return [frames[number] for number in sorted(frames)]


def linked(frames: list[list[int]], fastest: float = FASTEST) -> list[dict[int, int]]:
    """Position by identity: who moved least to the next frame is the same person, nearest pairs first."""
    people = [dict(enumerate(frames[0]))]
    unused = len(frames[0])
    for places in frames[1:]:
        before = list(people[-1].items())
        pairs = nearest_pairs([position for _, position in before], places, fastest)
        identities = {there: before[here][0] for here, there in pairs}
        for there in range(len(places)):
            if there not in identities:
                identities[there] = unused
                unused += 1
        people.append({identities[there]: position for there, position in enumerate(places)})
    return people


def nearest_pairs(before: list[int], after: list[int], fastest: float) -> list[tuple[int, int]]:
    """Indices of those who can be the same, each at most once."""
    moved = np.linalg.norm(GRID.metres(before)[:, None] - GRID.metres(after)[None], axis=2)
    pairs: list[tuple[int, int]] = []
    for flat in np.argsort(moved, axis=None, kind="stable"):
        here, there = divmod(int(flat), len(after))
        if moved[here, there] > fastest * SECONDS:
            break
        if all(here != one and there != other for one, other in pairs):
            pairs.append((here, there))
    return pairs


def annotate(
    browser: Browser,
    frames: list[dict[int, int]],
    plan: dict[str, Any],
    proposed: dict[str, Any] | None = None,
    told: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """What the annotator did; `told`: the scene, if it is not WILDTRACK's."""
    page = browser.new_context(viewport=SCREEN).new_page()
    page.set_default_timeout(0)
    page.on("pageerror", lambda error: sys.exit(f"{plan}: {error}"))
    page.route(ADDRESS + "**", answer)
    page.goto(ADDRESS)
    told = {**(told or scene(len(frames))), "proposed": "proposals" in plan}
    proposed = proposed or proposals(frames)
    job = {"scene": told, "truth": frames, "plan": plan, "seed": SEED, "proposed": proposed}
    report: dict[str, Any] = page.evaluate(
        "async (job) => (await import('/benchmarks/effort.js')).work(job)", job
    )
    page.context.close()
    return report


def proposals(frames: list[dict[int, int]]) -> dict[str, Any]:
    """As exact as those of pictures: 4.5 cm off, one in a hundred missed, one in a hundred nobody."""
    rng = np.random.default_rng(SEED)
    numbers = count()
    found = []
    for index, people in enumerate(frames):
        seen = {track: GRID.metres([place])[0] for track, place in people.items() if rng.random() > MISSED}
        proposed = [person(next(numbers), track, xy + rng.normal(0, SPREAD, 2)) for track, xy in seen.items()]
        if rng.random() < FALSE * len(people):
            proposed.append(person(next(numbers), 10**6 + index, rng.uniform((-2, -8), (8, 26))))
        found.append({"number": index * FRAME_STEP, "people": proposed, "refused": []})
    return {"run": 1, "threshold": 0.5, "frames": found}


def person(number: int, track: int, xy: Any, score: float = 0.9, grid: Grid = GRID) -> dict[str, Any]:
    return {
        **{"id": number, "position": int(grid.nearest(np.array([xy]))[0]), "track": track, "person": None},
        **{"height": None, "radius": None, "score": score, "doubt": 1 - score, "evidence": []},
        **{"seated": False, "filled": False},
    }


def answer(route: Route) -> None:
    """The page and the files it is made of, without a server."""
    name = route.request.url.removeprefix(ADDRESS)
    path = ROOT / name
    if not name:
        route.fulfill(content_type="text/html", body=PAGE)
    elif path.is_file():
        route.fulfill(content_type=TYPES[path.suffix], body=path.read_bytes())
    else:
        route.fulfill(status=404)


def scene(
    frames: int,
    cameras: Sequence[Camera] | None = None,
    grid: Grid = GRID,
    rule: FootRule = FootRule.CORNERS,
) -> dict[str, Any]:
    """What the server would say about an assignment of so many frames, without pictures."""
    cameras = cameras or load_cameras(ROOT / "fixtures" / "wildtrack_cameras.json")
    return {
        "mode": "assignment",
        "dataset": {
            "slug": "wildtrack",
            "name": "WILDTRACK",
            "seconds_per_frame": SECONDS,
            "frame_step": FRAME_STEP,
        },
        "grid": {
            "columns": grid.columns,
            "rows": grid.rows,
            "step": grid.step,
            "origin": [grid.origin_x, grid.origin_y],
        },
        "cylinder": {"radius": 0.16, "height": 1.8},
        "sizes": {"height": HEIGHTS, "radius": RADII},
        "foot_rule": rule.value,
        "cameras": [
            {
                "index": camera.index,
                "name": camera.name,
                "width": camera.width,
                "height": camera.height,
                "matrix": camera.matrix.tolist(),
                "rotation": camera.rotation.tolist(),
                "tvec": camera.tvec.tolist(),
                "distortion": camera.distortion.tolist(),
            }
            for camera in cameras
        ],
        "frames": [
            {"number": index * FRAME_STEP, "images": [], "revision": 0, "done": False, "nobody": False}
            for index in range(frames)
        ],
        "layer": {"id": 1, "name": "effort"},
        "editable": True,
        "read_only_reason": "",
        "assignment": None,
        "next_person": 1,
    }


if __name__ == "__main__":
    main()
