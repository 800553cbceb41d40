from __future__ import annotations

from dataclasses import replace

import numpy as np

from gtm_hit.calibration.adjustment.adjusting import adjust
from gtm_hit.calibration.adjustment.correspondences import correspondences
from gtm_hit.calibration.adjustment.settings import Variant
from gtm_hit.formats.calibration.pos_file import parse_pos
from tests.calibration.adjustment.scene import centres_off, scene


def pos(text: str) -> object:
    return parse_pos(text.encode(), "0.pos")


def test_the_same_identity_in_the_same_frame_is_one_person() -> None:
    files = {
        ("C1", "000000"): pos("ada\n0 10 20\n1 11 5\n"),
        ("C2", "000000"): pos("ada\n1 30 40\n2 31 25\nbob\n1 7 8\n"),
        ("C2", "000005"): pos("ada\n0 50 60\n"),
    }
    found = correspondences(["C1", "C2"], files)
    assert found.names == (
        ("000000", "ada", "feet"),
        ("000000", "ada", "head"),
        ("000000", "bob", "feet"),
        ("000005", "ada", "feet"),
    )
    clicks = zip(found.seen.cameras, found.seen.points, found.seen.pixels.tolist(), strict=True)
    assert sorted((int(camera), int(point), *pixel) for camera, point, pixel in clicks) == [
        (0, 0, 10.0, 20.0),
        (0, 1, 11.0, 5.0),
        (1, 0, 30.0, 40.0),
        (1, 1, 31.0, 25.0),
        (1, 2, 7.0, 8.0),
        (1, 3, 50.0, 60.0),
    ]
    assert found.feet.tolist() == [True, False, True, True]


def test_people_clicked_picture_by_picture_adjust_the_cameras() -> None:
    problem, _ = scene(cameras=3, noise=0.3)
    lines: dict[str, list[str]] = {name: [] for name in problem.names}
    for camera, point, (x, y) in zip(
        problem.seen.cameras, problem.seen.points, problem.seen.pixels, strict=True
    ):
        person = f"person {point // 2}"
        mine = lines[problem.names[camera]]
        mine += [f"{point % 2} {x!s} {y!s}"] if person in mine else [person, f"{point % 2} {x!s} {y!s}"]
    files = {(name, "000000"): pos("\n".join(mine)) for name, mine in lines.items()}
    found = correspondences(problem.names, files)
    result = adjust(replace(problem, points=found.points, seen=found.seen, feet=found.feet), Variant.FIXED)
    assert len(found.seen.pixels) == len(problem.seen.pixels)
    assert np.isfinite(result.points[:, 2]).sum() > 40
    assert centres_off(result.views).max() < 0.03
