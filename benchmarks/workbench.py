"""How fast the workbench is in headless Chromium, against a real server: `python -m benchmarks.workbench`.

A street seen by seven views with 24 people (and by twelve with 60) is made in a temporary folder. Names of
parts run only these: `python -m benchmarks.workbench cold keys`; the parts are listed by `--help`.

`ScriptDuration` is Chromium's count of all script of the page, in processor time of the page's thread. Beside
the workbench's own it holds this benchmark's TIMER and what Playwright runs per key, so the same number of
keys that mean nothing is pressed as well, and both figures and their difference are printed.
"""

from __future__ import annotations

import argparse
import json
import os
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median, quantiles
from typing import Any

from playwright.sync_api import Browser, Page, Request, ViewportSize, sync_playwright

ROOT = Path(__file__).resolve().parent.parent
CHROMIUM = "/usr/bin/chromium"
SCREEN: ViewportSize = {"width": 1920, "height": 1080}
KEYS = 120
NO_MEANING = "F8"  # a key the workbench does not know
WALK = 200  # frames
HELD = 7 * 480 * 1440 * 8 / 1e6  # int16 boxes of seven views
# A poor mobile line: every answer two seconds late.
SLOW = {"offline": False, "latency": 2000, "downloadThroughput": 20_000, "uploadThroughput": 10_000}

# Time from a key's event to the second animation frame after it: by then its pixels were handed over.
TIMER = """
() => {
  window.samples = [];
  document.addEventListener("keydown", () => {
    const start = performance.now();
    requestAnimationFrame(() => requestAnimationFrame(() => window.samples.push(performance.now() - start)));
  }, true);
}
"""
# Time until every view shows the new frame's picture and has painted.
FRAME_TIMER = """
() => {
  window.frames_taken = [];
  const panes = [...document.querySelectorAll(".pane")];
  const ready = () => panes.every((pane) => pane.dataset.picture === "ready");
  document.addEventListener("keydown", () => {
    const start = performance.now();
    const place = document.querySelector(".place").textContent;
    const look = () => {
      const moved = document.querySelector(".place").textContent !== place;
      if (!moved || !ready()) return requestAnimationFrame(look);
      requestAnimationFrame(() => window.frames_taken.push(performance.now() - start));
    };
    requestAnimationFrame(look);
  }, true);
}
"""
FIRST_VIEW = """
() => document.querySelector("[data-ready] [data-view^=camera][data-picture=ready]") && performance.now()
"""
ALL_VIEWS = """
() => {
  const panes = [...document.querySelectorAll(".pane")];
  return panes.length && panes.every((pane) => pane.dataset.picture === "ready") && performance.now();
}
"""
DECODED = "performance.getEntriesByName('grid file').map(({duration}) => duration)"
PROGRAM_BYTES = """
() => performance.getEntriesByType("resource")
  .filter(({name}) => /\\.(js|css)$/.test(name))
  .reduce((sum, {decodedBodySize}) => sum + decodedBodySize, 0)
"""
SEED = """
import sys
from gtm_hit.models import Layer
from gtm_hit.ops.frames.saving import save_frame
from tests.browser import street
import uuid, json
def rows(places):
    return [{"person": i + 1, "position": int(p), "state": "validated", "origin": "clicked",
             "height": None, "radius": None} for i, p in enumerate(places)]
def prepare(slug, people, frames, views):
    made = street.make_street(people=people, frames=frames, size=frames, slug=slug, views=views)
    assignment = made.claim(slug)
    for index, frame in enumerate(made.frames):
        people = rows(made.truth[index])
        save_frame(assignment.layer, frame, assignment.worker, uuid.uuid4(), 0, people, done=True)
    return street.workbench_path(assignment)
print(json.dumps({"usual": prepare("usual", 24, 24, 7), "large": prepare("large", 60, 2, 12)}))
"""


def main() -> None:
    chosen = chosen_parts()
    with (
        tempfile.TemporaryDirectory() as folder,
        server(Path(folder)) as (address, paths),
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        for part in chosen:
            title, scene, measure = PARTS[part]
            started = time.monotonic()
            figures = measure(browser, address + paths[scene])
            report(f"{title}  ({part}, {time.monotonic() - started:.0f} s)", figures)
        browser.close()


def chosen_parts() -> list[str]:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "parts", nargs="*", metavar="part", help=f"any of {', '.join(PARTS)}; all if none is named"
    )
    chosen: list[str] = parser.parse_args().parts
    unknown = [part for part in chosen if part not in PARTS]
    if unknown:
        parser.error(f"no such part: {', '.join(unknown)}; there are {', '.join(PARTS)}")
    return chosen or list(PARTS)


@contextmanager
def server(folder: Path, seed: str = SEED) -> Iterator[tuple[str, dict[str, Any]]]:
    """A production-like server of its own; yields its address and what the seed printed."""
    environment = environment_in(folder)
    manage = [sys.executable, "manage.py"]
    for command in (["migrate", "-v0"], ["collectstatic", "--noinput", "-v0"]):
        subprocess.run([*manage, *command], cwd=ROOT, env=environment, check=True)
    seeded = subprocess.run(
        [*manage, "shell", "-v0", "-c", seed],
        cwd=ROOT,
        env=environment,
        check=True,
        capture_output=True,
        text=True,
    )
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [
        sys.executable,
        "-m",
        "gunicorn",
        "annotator.wsgi",
        "--threads",
        "8",
        "-b",
        f"127.0.0.1:{port}",
    ]
    process = subprocess.Popen([*command, "--log-level", "warning"], cwd=ROOT, env=environment)
    try:
        address = f"http://127.0.0.1:{port}"
        wait_for(address + "/login/")
        yield address, json.loads(seeded.stdout.strip().splitlines()[-1])
    finally:
        process.terminate()
        process.wait()


def environment_in(folder: Path) -> dict[str, str]:
    return {**os.environ, "DATA_DIR": str(folder), "SECRET_KEY": "b" * 50, "LOG_LEVEL": "WARNING"}


def wait_for(address: str) -> None:
    for _ in range(100):
        try:
            urllib.request.urlopen(address)
            return
        except OSError:
            time.sleep(0.1)
    raise RuntimeError(f"{address} does not answer")


def opened(browser: Browser, address: str) -> Page:
    page = browser.new_context(viewport=SCREEN).new_page()
    page.goto(address)
    page.wait_for_selector("[data-ready]")
    page.wait_for_function(ALL_VIEWS)
    page.wait_for_load_state("networkidle")
    return page


def cold_start(browser: Browser, address: str) -> dict[str, float]:
    usable, complete, weights = [], [], []
    for _ in range(7):
        context = browser.new_context(viewport=SCREEN)
        page = context.new_page()
        page.goto(address, wait_until="commit")
        usable.append(page.wait_for_function(FIRST_VIEW, polling="raf").json_value())
        complete.append(page.wait_for_function(ALL_VIEWS, polling="raf").json_value())
        weights.append(page.evaluate(PROGRAM_BYTES))
        context.close()
    return {
        "first usable view, ms": median(usable),
        "all views, ms": median(complete),
        "script + style, kB": max(weights) / 1000,
    }


def grid_files(browser: Browser, address: str) -> dict[str, float]:
    """What the worker needs to unpack and decode one camera's table, and what the page then holds."""
    taken: list[float] = []
    for _ in range(5):
        page = browser.new_context(viewport=SCREEN).new_page()
        page.goto(address)
        page.wait_for_selector("[data-ready]")
        page.wait_for_function(f"() => {DECODED}.length === 7", timeout=60_000)
        taken += page.evaluate(DECODED)
        page.context.close()
    return {"a camera decoded, median ms": median(taken), "slowest ms": max(taken), "boxes held, MB": HELD}


def arrow_keys(browser: Browser, address: str) -> dict[str, float]:
    page = opened(browser, address)
    requests: list[str] = []
    page.keyboard.press("Tab")
    page.wait_for_timeout(2000)  # until the parts that come after the first action are here
    page.evaluate(TIMER)
    client = page.context.new_cdp_session(page)
    # Processor time of the page's own thread: with other programs at work, the clock counts their time, too.
    client.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.on("request", lambda request: note(requests, request))
    nothing = script_per_key(page, client, [NO_MEANING])
    page.evaluate("window.samples = []")
    script = script_per_key(page, client, ["ArrowRight", "ArrowLeft"])
    samples = page.evaluate("window.samples")
    figures = {
        "keydown → painted, median ms": median(samples),
        "p95 ms": quantiles(samples, n=20)[-1],
        "script per arrow key, ms": script,
        "script per key without meaning, ms": nothing,
        "script per key, ms": script - nothing,
        "requests but saves": len(requests),
        "steps from 60 repeats": held_key(page),
    }
    page.context.close()
    return figures


def script_per_key(page: Page, client: Any, keys: list[str]) -> float:
    """Milliseconds of script, whatever comes later (saves, for instance) included."""
    before = metric(client, "ScriptDuration")
    press_often(page, keys)
    page.wait_for_timeout(1000)
    return (metric(client, "ScriptDuration") - before) / KEYS * 1000


def press_often(page: Page, keys: list[str]) -> None:
    for index in range(KEYS):
        page.keyboard.press(keys[index % len(keys)])
        page.wait_for_timeout(37 + index % 13)  # no rhythm with the screen
    page.wait_for_timeout(100)


def slow_network(browser: Browser, address: str) -> dict[str, float]:
    """Arrow keys in the next frame while neither its pictures nor saves get through in time."""
    page = opened(browser, address)
    client = page.context.new_cdp_session(page)
    client.send("Network.enable")
    client.send("Network.emulateNetworkConditions", SLOW)
    page.keyboard.press("n")
    page.keyboard.press("Tab")
    page.evaluate(TIMER)
    press_often(page, ["ArrowRight", "ArrowLeft"])
    samples = page.evaluate("window.samples")
    page.context.close()
    return {"keydown → painted, median ms": median(samples), "p95 ms": quantiles(samples, n=20)[-1]}


def note(requests: list[str], request: Request) -> None:
    if request.method != "PUT":
        requests.append(request.url)


def held_key(page: Page) -> int:
    """Positions moved by 60 auto-repeated presses, as the panel says (metres / 2.5 cm)."""
    where = """() => document.querySelector(".details").textContent.match(/-?\\d+\\.\\d{3}/g).map(Number)"""
    before = page.evaluate(where)
    for _ in range(60):
        page.keyboard.down("ArrowRight")
    page.keyboard.up("ArrowRight")
    page.wait_for_timeout(200)
    after = page.evaluate(where)
    return round(sum(abs(one - other) for one, other in zip(before, after, strict=True)) / 0.025)


def next_frame(browser: Browser, address: str) -> dict[str, float]:
    page = opened(browser, address)
    page.evaluate(FRAME_TIMER)
    for index in range(100):
        page.keyboard.press("n" if index % 20 < 10 else "p")
        page.wait_for_timeout(150)
        page.wait_for_load_state("networkidle")
    samples = page.evaluate("window.frames_taken")
    page.context.close()
    return {"median ms": median(samples), "p95 ms": quantiles(samples, n=20)[-1], "frames": len(samples)}


def memory(browser: Browser, address: str) -> dict[str, float]:
    page = opened(browser, address)
    client = page.context.new_cdp_session(page)
    figures = {}
    for index in range(WALK + 1):
        if index in {WALK // 4, WALK // 2, WALK}:
            page.wait_for_timeout(500)
            client.send("HeapProfiler.collectGarbage")
            heap = client.send("Runtime.getHeapUsage")["usedSize"] / 1e6
            figures[f"heap after {index}, MB"] = heap
            figures[f"Chromium after {index}, MB"] = resident(page)
        page.keyboard.press("n" if index % 44 < 22 else "p")
        page.wait_for_timeout(120)
    page.context.close()
    return figures


def resident(page: Page) -> float:
    """Private memory of all of the browser's processes."""
    root = os.getpid()
    parents = {}
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        parents[int(status.parent.name)] = int(fields[1])
    total = 0
    for process in parents:
        ancestor, name = process, command_name(process)
        while ancestor not in {0, 1, root}:
            ancestor = parents.get(ancestor, 0)
        if ancestor == root and "chrom" in name:
            total += private_bytes(process)
    return total / 1e6


def command_name(process: int) -> str:
    try:
        return Path(f"/proc/{process}/comm").read_text()
    except OSError:
        return ""


def private_bytes(process: int) -> int:
    try:
        lines = Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0
    return sum(int(line.split()[1]) * 1024 for line in lines if line.startswith("Private_"))


def metric(client: Any, name: str) -> float:
    values = client.send("Performance.getMetrics")["metrics"]
    return next(entry["value"] for entry in values if entry["name"] == name)


def report(title: str, figures: dict[str, float]) -> None:
    print(title, flush=True)
    for name, value in figures.items():
        print(f"  {name:<36}{value:>9.1f}")


# name on the command line → what is printed, which scene, what measures it
PARTS: dict[str, tuple[str, str, Callable[[Browser, str], dict[str, float]]]] = {
    "cold": ("cold start", "usual", cold_start),
    "grids": ("grid files, 7 views", "usual", grid_files),
    "keys": ("arrow keys, 24 people × 7 views", "usual", arrow_keys),
    "large": ("arrow keys, 60 people × 12 views", "large", arrow_keys),
    "slow": ("placing on a slow network", "usual", slow_network),
    "frames": ("next frame, prefetched", "usual", next_frame),
    "memory": (f"memory over {WALK} frames", "usual", memory),
}

if __name__ == "__main__":
    main()
