"""How well offsets of videos are guessed; run with `python -m benchmarks.calibration_sync [--rendered]`.

The videos are made of the demo scene: with figures of a few strokes in all seven views, or, which takes a
quarter of an hour, three of them rendered as its pictures are.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import django
import numpy as np

from benchmarks.calibration_rows import Row, table
from gtm_hit.demo.backdrop import Place
from gtm_hit.demo.film import Take, film, quick_painter, smaller, true_painter, walks_for
from gtm_hit.demo.people import Cast
from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras, save_cameras

CAMERAS = Path(__file__).resolve().parent.parent / "fixtures" / "wildtrack_cameras.json"
RATES = (25.0, 30000 / 1001, 60000 / 1001, 30.0, 24.0, 50.0, 60000 / 1001)
STARTS = (2.0, 0.713, 3.297, 1.111, 4.05, 0.0, 2.468)  # seconds of the scene
BAR = 50.0  # milliseconds
SEED, WIDTH = 7, 480


def rows(data: Path | None, rendered: bool = False) -> list[Row]:
    """`data` is not needed: everything is made here."""
    found = [_row("sync: 7 drawn views, 24 to 59.94 pictures/s, 60 s", range(7), 60.0, False)]
    if rendered:
        found.append(_row("sync: 3 rendered views, 25, 30 and 59.94 pictures/s, 16 s", (0, 3, 6), 16.0, True))
    return found


def _row(name: str, views: Sequence[int], seconds: float, rendered: bool) -> Row:
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    os.environ.setdefault("SECRET_KEY", "k" * 50)
    django.setup()
    from gtm_hit.ops.sync.guessing import Video, guess  # after the settings

    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder:
        takes = [_take(view, seconds, Path(folder)) for view in views]
        with ProcessPoolExecutor(2, get_context("spawn")) as pool:
            list(pool.map(_film, takes, [rendered] * len(takes)))
        _write_cameras(Path(folder), takes)
        begun = time.perf_counter()
        videos = [Video(take.camera.name, take.path) for take in takes]
        places = guess(videos, Path(folder) / "cameras.json", seconds).places
        took = time.perf_counter() - begun
    # What is the same for all is no error: which instant is 0 is free.
    offsets = [np.nan if place.offset is None else place.offset for place in places]
    errors = np.array(offsets) + [take.start for take in takes]
    errors = 1000 * (errors - np.nanmedian(errors))
    worst = float(np.abs(errors).max())
    told = " ".join(f"{error:+.0f}" for error in errors)
    return Row(name, f"{worst:.0f} ms ({told}), guessed in {took:.0f} s", f"≤ {BAR:.0f} ms", worst <= BAR)


def _take(view: int, seconds: float, folder: Path) -> Take:
    camera = smaller(load_cameras(CAMERAS)[view], WIDTH)
    return Take(camera, folder / f"{camera.name}.mp4", STARTS[view], RATES[view], seconds)


def _film(take: Take, rendered: bool) -> None:
    scene = replace(read_scene(), seed=SEED)
    walks = walks_for(scene, take.seconds + max(STARTS))
    if rendered:
        cast = replace(Cast.of(scene), walks=walks)
        film(take, walks, true_painter(scene, take.camera, Place(scene), cast))
    else:
        film(take, walks, quick_painter(scene, take.camera))


def _write_cameras(folder: Path, takes: Sequence[Take]) -> None:
    save_cameras(folder / "cameras.json", [take.camera for take in takes])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rendered", action="store_true")
    options = parser.parse_args()
    print(table(rows(None, options.rendered)))


if __name__ == "__main__":
    main()
