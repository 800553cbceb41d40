"""What a dataset of an hour costs beside one of 400 frames: `python -m benchmarks.scale [LONG SHORT]`.

Makes a database of its own in a temporary folder and removes it. Frames of the long one have 24 people in
7 views: 36,000 frames, 252,000 images, 864,000 annotations.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Any

import django

from benchmarks.requests import queries_of

PEOPLE = 24
TIMES = 9
ROOT = Path(__file__).resolve().parent.parent


def prepare(folder: str) -> None:
    os.environ.update(DJANGO_SETTINGS_MODULE="annotator.settings", DATA_DIR=folder, DEBUG="0")
    os.environ.update(
        SECRET_KEY="k" * 50, DATABASE_URL=f"sqlite:///{folder}/scale.sqlite3", LOG_LEVEL="ERROR"
    )
    os.environ["ALLOWED_HOSTS"] = "testserver"
    django.setup()


def build(slug: str, frames: int) -> None:
    """Rows only: images are addressed, and nobody opens them here."""
    import numpy as np

    from gtm_hit.models import Dataset, Layer
    from gtm_hit.ops.ground import coverage
    from gtm_hit.ops.work import batches

    dataset = Dataset.objects.create(slug=slug, name=slug)
    make_cameras(dataset)
    layer = Layer.objects.create(
        dataset=dataset, name="truth", kind=Layer.Kind.STAFF, last_person=frames + PEOPLE
    )
    positions = np.random.default_rng(1).integers(0, dataset.grid.count, (frames, PEOPLE)).tolist()
    for first in range(0, frames, 2000):
        fill(layer, range(first, min(first + 2000, frames)), positions)
    batches.make_batches(dataset)
    coverage.table(dataset)


def make_cameras(dataset: Any) -> None:
    from gtm_hit.formats.calibration.cameras_json import load_cameras

    for camera in load_cameras(ROOT / "fixtures" / "wildtrack_cameras.json"):
        dataset.cameras.create(
            index=camera.index,
            name=camera.name,
            width=camera.width,
            height=camera.height,
            matrix=camera.matrix.tolist(),
            rvec=camera.rvec.tolist(),
            tvec=camera.tvec.tolist(),
        )


def fill(layer: Any, numbers: range, positions: list[list[int]]) -> None:
    """Frames with their images and people."""
    from gtm_hit.models import Annotation, Frame, Image, LayerFrame

    cameras = list(layer.dataset.cameras.order_by("index"))
    rows = Frame.objects.bulk_create(Frame(dataset=layer.dataset, number=5 * number) for number in numbers)
    LayerFrame.objects.bulk_create(LayerFrame(layer=layer, frame=row, revision=1) for row in rows)
    Image.objects.bulk_create(
        Image(
            frame=row,
            camera=camera,
            source_digest="0" * 64,
            light_digest=f"{row.pk:056x}{camera.pk:07x}1",
            full_digest=f"{row.pk:056x}{camera.pk:07x}2",
            light_bytes=1,
            full_bytes=1,
        )
        for row in rows
        for camera in cameras
    )
    Annotation.objects.bulk_create(
        Annotation(layer=layer, frame=row, person=number // 40 + person, position=position)
        for row, number in zip(rows, numbers, strict=True)
        for person, position in enumerate(positions[number])
    )


def measure(slug: str, middle: int) -> dict[str, tuple[int, float]]:
    """Queries and median milliseconds, whole requests as staff."""
    from django.contrib.auth.models import User
    from django.test import Client

    from gtm_hit.models import Layer

    user, _made = User.objects.get_or_create(username="staff", is_superuser=True)
    client = Client()
    client.force_login(user)
    layer = Layer.objects.get(dataset__slug=slug, name="truth")
    frame = f"/api/v1/layers/{layer.pk}/frames/{middle}/"

    def save(revision: int) -> Any:
        people = client.get(frame).json()["annotations"]
        body = {"save_id": str(uuid.uuid4()), "revision": revision, "annotations": people}
        return lambda: client.put(frame, body, content_type="application/json")

    found = {"open a frame": timed([lambda: client.get(frame)] * TIMES)}
    found["save a frame"] = timed([save(1 + number) for number in range(TIMES)])
    listed = f"/api/v1/datasets/{slug}/layers/truth/annotations/?from={middle}&frames=20"
    for name, address in {
        "dataset page": f"/datasets/{slug}/",
        "layers page": f"/datasets/{slug}/layers/",
        "batches page": f"/datasets/{slug}/batches/",
        "exports page": "/exports/",
        "annotations of 20 frames": listed,
        "100 frames of REST": f"/api/v1/datasets/{slug}/frames/?from={middle}",
    }.items():
        client.get(address)  # coverage is computed once per dataset
        found[name] = timed([lambda address=address: client.get(address)] * TIMES)
    return found


def timed(calls: list[Any]) -> tuple[int, float]:
    count = queries_of(calls[0])
    taken = []
    for call in calls[1:]:
        start = time.perf_counter()
        assert call().status_code == 200
        taken.append(1000 * (time.perf_counter() - start))
    return count, statistics.median(taken)


def export(slug: str) -> dict[str, float]:
    from gtm_hit.models import Layer
    from gtm_hit.ops.exports import exporting

    layer = Layer.objects.select_related("dataset").get(dataset__slug=slug, name="truth")
    folder = Path(os.environ["DATA_DIR"]) / "out"
    began: dict[str, float] = {}
    ended: dict[str, float] = {}
    start, cpu, own = time.perf_counter(), time.process_time(), time.thread_time()
    used: dict[str, float] = {}
    used_here: dict[str, float] = {}

    def report(phase: str, done: int, total: int) -> None:
        now = time.perf_counter() - start
        began.setdefault(phase, now)
        ended[phase] = now
        used[phase] = time.process_time() - cpu
        used_here[phase] = time.thread_time() - own

    manifest = exporting.export_layer(layer, folder, folder.with_name("partial"), report)
    frames = manifest.counts["frames"]
    return {
        "frames/s of files and zip": frames / (ended[exporting.FRAMES] - began[exporting.FRAMES]),
        "frames/s of files, processor time": frames / used_here[exporting.FRAMES],
        "frames/s of files and zip, processor time": frames / used[exporting.FRAMES],
        "frames/s in all": frames / (time.perf_counter() - start),
        "seconds to the first report": min(began.values()),
        "peak MB of the process": peak(),
    }


def import_back(slug: str) -> dict[str, float]:
    """The JSON just exported, as a layer of the same dataset."""
    from gtm_hit.models import Dataset
    from gtm_hit.ops.layers.importing import AnnotationSource, import_annotations

    folder = Path(os.environ["DATA_DIR"]) / "out"
    start, cpu = time.perf_counter(), time.process_time()
    source = AnnotationSource(folder, "wildtrack", "again", False, [])
    found = import_annotations(
        Dataset.objects.get(slug=slug), source, lambda *_: None, lambda: None, lambda _: None
    )
    return {
        "frames/s of import": found.frames / (time.perf_counter() - start),
        "frames/s of import, processor time": found.frames / (time.process_time() - cpu),
        "peak MB of the process": peak(),
    }


def quality(slug: str) -> dict[str, float]:
    """The statistics of the layer."""
    from gtm_hit.models import Layer
    from gtm_hit.ops.quality.statistics.measuring import layer_statistics

    layer = Layer.objects.select_related("dataset").get(dataset__slug=slug, name="truth")
    start = time.perf_counter()
    layer_statistics(layer)
    return {"seconds": time.perf_counter() - start, "peak MB of the process": peak()}


def compare(slug: str) -> dict[str, float]:
    """All frames of the layer against those that were imported, as `manage.py comparelayers` does."""
    from gtm_hit.models import Layer
    from gtm_hit.ops.quality import comparing

    layers = Layer.objects.select_related("dataset").filter(dataset__slug=slug)
    start = time.perf_counter()
    comparing.compare(layers.get(name="truth"), layers.get(name="again"))
    return {"seconds": time.perf_counter() - start, "peak MB of the process": peak()}


def release(slug: str) -> dict[str, float]:
    """In the formats releases have by default."""
    from gtm_hit.models import Layer
    from gtm_hit.ops.releases import releasing

    layer = Layer.objects.select_related("dataset").get(dataset__slug=slug, name="truth")
    partial = Path(os.environ["DATA_DIR"]) / "exports" / "release.partial-0-0"
    start, cpu = time.perf_counter(), time.process_time()
    releasing.make_release(releasing.Order(layer, "For research only."), partial, lambda *_: None)
    return {
        "seconds": time.perf_counter() - start,
        "seconds, processor time": time.process_time() - cpu,
        "peak MB of the process": peak(),
    }


def peak() -> float:
    """Of this process alone: what rusage tells begins with the parent's."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


LONG_WORK: dict[str, Callable[[str], dict[str, float]]] = {
    "export": export,
    "import": import_back,
    "statistics": quality,
    "comparison": compare,
    "release": release,
}
STEPS: dict[str, Callable[..., Any]] = {"build": build, "measure": measure, **LONG_WORK}


def apart(folder: str, step: str, *arguments: Any) -> Any:
    """In a process of its own, whose memory is nobody else's."""
    command = [sys.executable, "-m", "benchmarks.scale", "--step", folder, step, json.dumps(arguments)]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    return json.loads(done.stdout.splitlines()[-1])


def main(long: int, short: int) -> None:
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder:
        prepare(folder)
        from django.core.management import call_command

        call_command("migrate", verbosity=0)
        call_command("collectstatic", interactive=False, verbosity=0)
        found = {}
        for slug, frames in (("short", short), ("long", long)):
            start = time.perf_counter()
            apart(folder, "build", slug, frames)
            print(f"{slug}: {frames} frames made in {time.perf_counter() - start:.0f} s", flush=True)
        for slug, frames in (("short", short), ("long", long)):
            found[slug] = apart(folder, "measure", slug, 5 * (frames // 2))
        print(f"{'':26} {short:>7} frames     {long:>7} frames")
        for name in found["short"]:
            (few, quick), (many, slow) = found["short"][name], found["long"][name]
            print(f"{name:26} {few:3} q {quick:7.1f} ms   {many:3} q {slow:7.1f} ms", flush=True)
        for step in LONG_WORK:
            for name, value in apart(folder, step, "long").items():
                print(f"{step}: {name:38} {value:8.1f}", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--step"]:
        prepare(sys.argv[2])
        print(json.dumps(STEPS[sys.argv[3]](*json.loads(sys.argv[4]))))
    else:
        long, short = map(int, sys.argv[1:3]) if len(sys.argv) > 2 else (36_000, 400)
        main(long, short)
