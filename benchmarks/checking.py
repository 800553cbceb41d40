"""A batch of the demo scene with proposals against the same batch without: `python -m benchmarks.checking`.

Ten frames at the real workbench, in Chromium, by two scripted annotators (tests/browser/scripted.py): one
checks what the built-in detector proposes (`make detector`) and goes by nothing but the screen; the other has
no proposals, sees the feet of everybody in the pictures, and clicks on them. Results are asked for when the
batch is submitted. Seconds are the script's, and a person's by the keystroke-level model (a key 0.28 s,
pointing 1.1 s, a click 0.2 s, a decision 1.35 s). `--pictures FOLDER` keeps what the screen shows.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, ViewportSize, sync_playwright

from benchmarks.workbench import ALL_VIEWS, CHROMIUM, ROOT, SCREEN, environment_in, server
from gtm_hit.vision import detectors
from tests.browser.scripted import Annotator, Checker, Clicker, Feet

FRAMES = 10
SIZES: list[ViewportSize] = [{"width": 1280, "height": 800}, {"width": 1920, "height": 1080}]
SEED = """
import json, sys
from django.core.management import call_command
from gtm_hit.models import Annotation, Dataset
from gtm_hit.ops.work import assignments, batches, links, workers
call_command("makedemo", frames=FRAMES, stdout=sys.stderr)
call_command("propose", "demo", stdout=sys.stderr)
dataset = Dataset.objects.get(slug="demo")
batches.make_batches(dataset, copies=2)
made = {}
for worker in ("checker", "clicker"):
    assignment = assignments.claim(workers.enter("link", worker), dataset)
    made[worker] = [f"/annotate/{links.assignment_token(assignment)}/", assignment.layer.name]
truth = Annotation.objects.filter(layer__name="truth", layer__dataset=dataset)
made["truth"] = [
    list(truth.filter(frame=frame).values_list("person", "position"))
    for frame in dataset.frames.order_by("number")
]
print(json.dumps(made))
"""
NO_PROPOSALS = (
    "from gtm_hit.models import Dataset; from gtm_hit.ops.proposals import runs; "
    "runs.use_none(Dataset.objects.get(slug='demo'))"
)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--frames", type=int, default=FRAMES)
    parser.add_argument("--detector", type=Path, default=detectors.built_in_path(ROOT / "var"))
    parser.add_argument("--pictures", type=Path, help="folder for pictures of the screen")
    options = parser.parse_args()
    if not options.detector.is_file():
        print("No detector (make detector): nobody is proposed, and there is nothing to compare.")
        return
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder, sync_playwright() as playwright:
        kept = detectors.built_in_path(Path(folder))
        kept.parent.mkdir()
        shutil.copy(options.detector, kept)
        with server(Path(folder), SEED.replace("FRAMES", str(options.frames))) as (address, made):
            browser = playwright.chromium.launch(
                executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"]
            )
            compare(browser, Path(folder), address, made, options.pictures)
            browser.close()


def compare(
    browser: Browser, folder: Path, address: str, made: dict[str, Any], pictures: Path | None
) -> None:
    truth = [[Feet(person, position) for person, position in frame] for frame in made["truth"]]
    people = sum(map(len, truth))
    print(f"{len(truth)} frames, {people} people")
    heads = ("actions", "each", "keys", "clicks", "points", "s", "human s", "MODA", "MODP", "IDF1")
    print(f"{'':<20}" + "".join(f"{head:>9}" for head in heads))
    path, layer = made["checker"]
    if pictures:
        keep_pictures(browser, address + path, pictures)
    page = browser.new_context(viewport=SCREEN).new_page()
    checker = Checker(page, len(truth))
    report("with proposals", checker, timed(checker, address + path), people, judged(folder, layer))
    page.context.close()
    manage(folder, "shell", "-v0", "-c", NO_PROPOSALS)
    path, layer = made["clicker"]
    page = browser.new_context(viewport=SCREEN).new_page()
    clicker = Clicker(page, truth)
    report("without", clicker, timed(clicker, address + path), people, judged(folder, layer))
    page.context.close()


def timed(annotator: Annotator, address: str) -> float:
    annotator.open(address)
    began = time.perf_counter()
    annotator.do_batch()
    return time.perf_counter() - began


def report(name: str, annotator: Annotator, seconds: float, people: int, judgement: dict[str, float]) -> None:
    hands = annotator.hands
    counts = [hands.counts[kind] for kind in ("keys", "clicks", "pointings")]
    counted = "".join(f"{count:>9}" for count in counts)
    scores = "".join(f"{100 * judgement[name]:>9.1f}" for name in ("moda", "modp", "idf1"))
    each = f"{hands.actions / people:>9.2f}"
    print(
        f"{name:<20}{hands.actions:>9}{each}{counted}{seconds:>9.1f}{hands.human_seconds:>9.0f}{scores}",
        flush=True,
    )


def judged(folder: Path, layer: str) -> dict[str, float]:
    """The submitted layer against the truth."""
    scores: dict[str, float] = json.loads(manage(folder, "comparelayers", "demo", "truth", layer, "--json"))
    return scores


def manage(folder: Path, *command: str) -> str:
    return subprocess.run(
        [sys.executable, "manage.py", *command],
        cwd=ROOT,
        env=environment_in(folder),
        check=True,
        capture_output=True,
        text=True,
    ).stdout


def keep_pictures(browser: Browser, address: str, folder: Path) -> None:
    """The first frame as it is opened, with what speaks for a proposal, and after all are accepted."""
    folder.mkdir(parents=True, exist_ok=True)
    for size in SIZES:
        page = browser.new_context(viewport=size).new_page()
        checker = Checker(page, FRAMES)
        checker.open(address)
        page.wait_for_function(ALL_VIEWS)
        name = f"proposals-{size['width']}"
        page.screenshot(path=folder / f"{name}.png")
        shown = checker.eyes.proposals()
        page.mouse.move(*max(shown, key=lambda mark: mark.height).middle)
        checker.eyes.marks()
        page.screenshot(path=folder / f"{name}-evidence.png")
        page.context.close()


if __name__ == "__main__":
    main()
