"""How long the demo scene takes to render; run with `python -m benchmarks.demo_scene [FRAMES]`."""

from __future__ import annotations

import resource
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

from gtm_hit.demo.render import WORKERS, render_scene
from gtm_hit.demo.scene import read_scene
from gtm_hit.formats.calibration.cameras_json import load_cameras

CAMERAS = Path(__file__).resolve().parent.parent / "fixtures" / "wildtrack_cameras.json"


def main(frames: int) -> None:
    scene, cameras = replace(read_scene(), frame_count=frames), load_cameras(CAMERAS)
    times: list[float] = []
    start = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="gtm-benchmark-") as folder:
        render_scene(
            scene, cameras, Path(folder), lambda done, total: times.append(time.perf_counter() - start)
        )
        size = sum(path.stat().st_size for path in Path(folder).rglob("*.jpg"))
    took, place = times[-1], times[len(cameras) - 1]
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    pictures = len(cameras) * frames
    print(f"{frames} frames × {len(cameras)} cameras, {WORKERS} processes")
    print(f"  the place     {place:7.2f} s")
    print(f"  the people    {took - place:7.2f} s  {pictures / (took - place):8.1f} pictures/s")
    print(f"  in all        {took:7.2f} s, {used.ru_utime + used.ru_stime:.1f} s of processor time")
    print(f"  memory        {used.ru_maxrss / 1024:7.0f} MB in the larger process")
    print(f"  files         {size / 1e6:7.1f} MB, {size / pictures / 1e3:.0f} kB per picture")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
