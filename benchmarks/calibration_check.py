"""Clicks in several views, in Python and in the browser's JavaScript, on fixtures/check_cases.json.

python -m benchmarks.calibration_check
"""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.calibration_rows import Bar, Row, absent, table
from gtm_hit.calibration.checking import Click, epipolar_line, shown, spot
from gtm_hit.geometry.camera import Camera

ROOT = Path(__file__).resolve().parent.parent
CASES = ROOT / "fixtures" / "check_cases.json"
REPAINT = 1000 / 60  # milliseconds between two pictures of a screen
AGREEING = Bar("check: places in all views and lines, Python and JavaScript apart", "≤ 0.01 px")
QUICK = Bar("check: one click more, all of seven views in JavaScript, median", "≤ 16.7 ms, one repaint")
BROWSER = """
    import { readFileSync } from "node:fs";
    import { Camera } from "./static/geometry/camera.js";
    import { epipolarLine } from "./static/geometry/epipolar.js";
    import { shown, spot } from "./static/geometry/spatial.js";
    const { cameras: facts, meetings, lines, sigma } = JSON.parse(readFileSync("fixtures/check_cases.json"));
    const cameras = facts.map((each) => new Camera(each));
    const clicks = (each) => each.clicks.map(([u, v], n) => ({ camera: cameras[each.cameras[n]], u, v }));
    const all = (each) => {
      const found = spot(clicks(each), sigma);
      return cameras.map((camera) => shown(camera, found.point)).map((at) => at && [at.x, at.y]);
    };
    const line = (each, other) =>
      epipolarLine({ camera: cameras[each.camera], u: each.click[0], v: each.click[1] }, cameras[other]);
    const took = [];
    for (let round = 0; round < 20; round += 1) for (const each of meetings) {
      const begun = performance.now();
      all(each);
      for (const [camera, [u, v]] of each.clicks.map((at, n) => [each.cameras[n], at]))
        for (let other = 0; other < 7; other += 1)
          if (other !== camera) epipolarLine({ camera: cameras[camera], u, v }, cameras[other]);
      took.push(performance.now() - begun);
    }
    took.sort((a, b) => a - b);
    console.log(JSON.stringify({
      places: meetings.map(all),
      lines: lines.map((each) => line(each, each.other).map(({ x, y }) => [x, y])),
      median: took[took.length >> 1],
    }));
"""


def rows(data: Path | None) -> list[Row]:
    """`data` is not needed: the cases come from scipy and OpenCV, and are the project's own."""
    if shutil.which("node") is None:
        return list(absent([AGREEING, QUICK], "node"))
    cases = json.loads(CASES.read_text())
    told = subprocess.run(
        ["node", "--input-type=module", "-e", BROWSER], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    browser = json.loads(told)
    worst, count = _apart(cases, browser)
    return [
        AGREEING.row(f"{worst:.2g} px at worst of {count} pixels", worst <= 0.01),
        QUICK.row(f"{browser['median']:.1f} ms", browser["median"] <= REPAINT),
    ]


def _apart(cases: dict[str, Any], browser: dict[str, Any]) -> tuple[float, int]:
    """The largest distance of a pixel here from the same there, and how many were compared."""
    cameras = [
        Camera(**{key: value for key, value in each.items() if key != "rotation"})
        for each in cases["cameras"]
    ]
    apart: list[float] = []
    for case, there in zip(cases["meetings"], browser["places"], strict=True):
        seen = zip(case["cameras"], case["clicks"], strict=True)
        found = spot([Click(cameras[at], *pixel) for at, pixel in seen], cases["sigma"])
        assert found, "every case meets"
        for camera, pixel in zip(cameras, there, strict=True):
            here = shown(camera, found.point)
            if _in_picture(camera, here) or (pixel and _in_picture(camera, np.array(pixel))):
                apart.append(_distance(here, pixel))
    for case, there in zip(cases["lines"], browser["lines"], strict=True):
        here = epipolar_line(Click(cameras[case["camera"]], *case["click"]), cameras[case["other"]])
        apart += [_distance(pixel, other) for pixel, other in zip(here, there, strict=True)]
    return max(apart), len(apart)


def _in_picture(camera: Camera, pixel: NDArray[np.float64]) -> bool:
    return bool((pixel >= 0).all() and (pixel <= (camera.width, camera.height)).all())


def _distance(here: NDArray[np.float64], there: Sequence[float] | None) -> float:
    """Infinite where only one of the two has an answer."""
    if np.isnan(here).any() or there is None:
        return 0.0 if np.isnan(here).any() and there is None else np.inf
    return float(np.hypot(*(here - there)))


if __name__ == "__main__":
    print(table(rows(None)))
