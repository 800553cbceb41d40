"""Statistics and comparison of a layer as long as an hour's video: `python -m benchmarks.layer_statistics`.

Makes a database of its own in a temporary folder and removes it.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import django

FRAMES, PEOPLE = 36_000, 24
STAY = 100  # frames, then the next people come


def prepare(folder: str) -> None:
    os.environ.update(DJANGO_SETTINGS_MODULE="annotator.settings", DATA_DIR=folder, DEBUG="0")
    os.environ.setdefault("SECRET_KEY", "k" * 50)
    django.setup()
    from django.core.management import call_command

    call_command("migrate", verbosity=0)


def build() -> None:
    from gtm_hit.formats.calibration.cameras_json import load_cameras
    from gtm_hit.models import Dataset, Frame, Layer, LayerFrame
    from gtm_hit.ops.datasets.rows import add_cameras

    dataset = Dataset.objects.create(slug="long", name="Long")
    add_cameras(dataset, load_cameras(Path("fixtures/wildtrack_cameras.json")))
    Frame.objects.bulk_create(
        (Frame(dataset=dataset, number=5 * index) for index in range(FRAMES)), batch_size=5000
    )
    frames = list(dataset.frames.values_list("pk", flat=True))
    for name in ("truth", "found"):
        layer = Layer.objects.create(dataset=dataset, name=name, kind=Layer.Kind.IMPORTED)
        LayerFrame.objects.bulk_create(
            (LayerFrame(layer=layer, frame_id=frame, revision=1) for frame in frames), batch_size=5000
        )
        insert(placed(layer.pk, frames, 0 if name == "truth" else 3))


def insert(rows: Iterator[tuple[int | str, ...]]) -> None:
    """Past the models: a million of them would take longer than what is measured."""
    from django.db import connection, transaction

    from gtm_hit.models import Annotation

    columns = "layer_id, frame_id, person, position, state, origin"
    with transaction.atomic(), connection.cursor() as cursor:
        cursor.executemany(
            f"INSERT INTO {Annotation._meta.db_table} ({columns}) VALUES (%s, %s, %s, %s, %s, %s)",
            list(rows),
        )


def placed(layer: int, frames: list[int], shift: int) -> Iterator[tuple[int | str, ...]]:
    """People who walk along the grid, one position aside for the other layer."""
    for index, frame in enumerate(frames):
        for slot in range(PEOPLE):
            person = index // STAY * PEOPLE + slot
            row = (person * 37 + 24 * (index % STAY)) % 1440
            yield layer, frame, person, row * 480 + slot * 20 + shift, "validated", "imported"


def report(name: str, work: Callable[[], object]) -> None:
    start, busy = time.perf_counter(), time.process_time()
    work()
    took, busy = time.perf_counter() - start, time.process_time() - busy
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{name:<64} {took:7.2f} s ({busy:6.2f} s CPU)   peak {peak:5.0f} MB", flush=True)


def main() -> None:
    with tempfile.TemporaryDirectory(prefix="layer-statistics-") as folder:
        prepare(folder)
        from gtm_hit.models import Layer
        from gtm_hit.ops.ground.coverage import table
        from gtm_hit.ops.quality.comparing import MOST_FRAMES, compare
        from gtm_hit.ops.quality.layer_rows import read_layer
        from gtm_hit.ops.quality.statistics.measuring import ground_coverage, layer_statistics

        # In a process of its own: what is measured here is the memory of reading, not of making.
        subprocess.run([sys.executable, "-m", "benchmarks.layer_statistics", folder], check=True)
        truth, found = (Layer.objects.select_related("dataset").get(name=name) for name in ("truth", "found"))
        table(truth.dataset)
        report("before anything", lambda: None)
        size = f"{FRAMES:,} frames × {PEOPLE} people"
        report(f"reading a layer, {size}", lambda: read_layer(truth))
        report(f"statistics of a layer, {size}", lambda: layer_statistics(truth))
        report("the same again, nothing saved in between", lambda: layer_statistics(truth))
        report("coverage of every 8th position", lambda: ground_coverage(truth.dataset))
        report(
            f"a page's comparison, {MOST_FRAMES:,} frames of them",
            lambda: compare(truth, found, most=MOST_FRAMES),
        )


if __name__ == "__main__":
    if len(sys.argv) > 1:
        prepare(sys.argv[1])
        build()
    else:
        main()
