"""How many bytes a frame of seven views costs at pane size, and how long its derivatives take.

python -m benchmarks.frame_bytes
"""

from __future__ import annotations

import io
import sys
import time
from collections.abc import Iterable
from pathlib import Path

from PIL import Image

from gtm_hit.demo.render import make_demo_frame
from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras
from gtm_hit.geometry.camera import undistort_maps
from gtm_hit.ops.files.images import Undistort, derive, remapper

REPOSITORY = Path(__file__).resolve().parent.parent
CAMERAS = REPOSITORY / "fixtures" / "wildtrack_cameras.json"
WILDTRACK = REPOSITORY.parent / "shared" / "data" / "wildtrack"
BUDGET = 2_500_000  # bytes

Source = tuple[bytes, Undistort | None]


def report(name: str, sources: Iterable[Source]) -> bool:
    light_bytes = full_bytes = views = 0
    seconds = 0.0
    for data, undistort in sources:
        start = time.process_time()
        light, full = derive(data, undistort)
        seconds += time.process_time() - start
        light_bytes, full_bytes, views = light_bytes + len(light), full_bytes + len(full), views + 1
    print(
        f"{name:44} {light_bytes / 1e6:5.2f} MB at pane size, {full_bytes / 1e6:5.2f} MB in full, "
        f"{1000 * seconds / views:4.0f} ms of processor time per view",
        flush=True,
    )
    return light_bytes <= BUDGET


def wildtrack() -> Iterable[Source]:
    ideal = load_cameras(CAMERAS)
    for camera, taken in zip(ideal, load_cameras(CAMERAS, original=True), strict=True):
        (path,) = (WILDTRACK / "original_frames" / f"C{camera.index + 1}").iterdir()
        yield path.read_bytes(), remapper(*undistort_maps(taken, camera.matrix))


def demo_scene() -> Iterable[Source]:
    scene = read_scene()
    for camera in load_cameras(CAMERAS):
        stream = io.BytesIO()
        Image.fromarray(make_demo_frame(scene, camera, 0)).save(stream, "JPEG", quality=92)
        yield stream.getvalue(), None


def main() -> int:
    within = []
    if WILDTRACK.is_dir():
        within.append(report("a real frame of WILDTRACK, undistorted", wildtrack()))
    else:
        print("a real frame of WILDTRACK: skipped, reference data not present: ../shared/data")
    within.append(report("a frame of the demo scene", demo_scene()))
    return 0 if all(within) else 1


if __name__ == "__main__":
    sys.exit(main())
