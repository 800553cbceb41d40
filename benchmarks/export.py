"""How fast a layer is exported, and with how much memory; run with `python -m benchmarks.export [FRAMES]`."""

from __future__ import annotations

import os
import resource
import sys
import tempfile
import time
from pathlib import Path

PEOPLE = 24  # in every frame, as in WILDTRACK


def main(frames: int) -> None:
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder:
        os.environ.update(SECRET_KEY="k" * 50, DATA_DIR=folder, DEBUG="false")
        os.environ["DATABASE_URL"] = f"sqlite:///{folder}/benchmark.sqlite3"
        os.environ["DJANGO_SETTINGS_MODULE"] = "annotator.settings"
        import django

        django.setup()
        measure(Path(folder), frames)


def measure(folder: Path, frames: int) -> None:
    from django.core.management import call_command

    from gtm_hit.ops.exports import exporting
    from gtm_hit.ops.ground import coverage

    call_command("migrate", verbosity=0)
    layer = make_layer(frames)
    coverage.table(layer.dataset)
    before = memory()
    times: dict[str, float] = {}
    cpu, start = time.process_time(), time.perf_counter()

    def report(phase: str, done: int, total: int) -> None:
        times[phase] = time.perf_counter() - start

    exporting.export_layer(layer, folder / "out", folder / "partial", report)
    took, cpu = time.perf_counter() - start, time.process_time() - cpu
    writing, packing = times[exporting.FRAMES], took - times[exporting.FRAMES]
    print(f"{frames} frames × {PEOPLE} people × 7 cameras")
    print(f"  JSON files  {writing:7.2f} s  {frames / writing:8.0f} frames/s")
    print(f"  rest        {packing:7.2f} s: the end of the zip, manifest, clearing up")
    print(f"  in all      {took:7.2f} s  {frames / took:8.0f} frames/s, {cpu:.2f} s of processor time")
    print(f"  memory      {memory() - before:7.0f} MB more than before, {memory():.0f} MB in all")


def make_layer(frames: int):  # type: ignore[no-untyped-def]
    import numpy as np

    from gtm_hit.formats.calibration.cameras_json import load_cameras
    from gtm_hit.models import Annotation, Dataset, Frame, Layer, LayerFrame
    from gtm_hit.ops.datasets.rows import add_cameras

    dataset = Dataset.objects.create(slug="benchmark", name="Benchmark")
    cameras = Path(__file__).resolve().parent.parent / "fixtures" / "wildtrack_cameras.json"
    add_cameras(dataset, load_cameras(cameras))
    layer = Layer.objects.create(dataset=dataset, name="people", kind=Layer.Kind.GROUND_TRUTH)
    positions = np.random.default_rng(1).integers(0, dataset.grid.count, (frames, PEOPLE)).tolist()
    for first in range(0, frames, 1000):
        numbers = range(first, min(first + 1000, frames))
        rows = Frame.objects.bulk_create(Frame(dataset=dataset, number=5 * number) for number in numbers)
        LayerFrame.objects.bulk_create(LayerFrame(layer=layer, frame=row, revision=1) for row in rows)
        Annotation.objects.bulk_create(
            Annotation(layer=layer, frame=row, person=person, position=position)
            for row, number in zip(rows, numbers, strict=True)
            for person, position in enumerate(positions[number])
        )
    return layer


def memory() -> float:
    """The most this process has held, in MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3000)
