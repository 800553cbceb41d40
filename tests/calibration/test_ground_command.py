from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.formats.calibration.wildtrack_xml import Intrinsic, intrinsic_xml
from tests.calibration.clicked import GRID, LENS, clicks, standing, swapped

CAMERA = standing()


@pytest.fixture
def lens(tmp_path: Path) -> Path:
    save_cameras(tmp_path / "cameras.json", [CAMERA])
    return tmp_path / "cameras.json"


def pair_file(folder: Path, pairs: list) -> Path:
    file = folder / "pairs.json"
    rows = [{"name": pair.name, "point": pair.point, "pixel": pair.pixel} for pair in pairs]
    file.write_text(json.dumps({"camera": "C1", "unit": "m", "pairs": rows}))
    return file


def run(*words: object) -> str:
    out = io.StringIO()
    call_command("calibrate", "ground", *map(str, words), stdout=out, stderr=io.StringIO())
    return out.getvalue()


def run_json(*words: object) -> dict[str, Any]:
    return json.loads(run(*words, "--json"))


def test_it_tells_rms_centre_and_each_pair(tmp_path: Path, lens: Path) -> None:
    told = run(pair_file(tmp_path, clicks(CAMERA)), "--lens", lens)
    assert "25 of 25 pairs agree" in told
    assert "centre 0.500 -6.000 4.000 m, ± " in told
    assert told.rstrip().endswith("Nothing looks wrong.")


def test_it_names_what_looks_wrong(tmp_path: Path, lens: Path) -> None:
    found = run_json(pair_file(tmp_path, swapped(clicks(CAMERA), 3, 10)), "--lens", lens)
    assert [each["text"] for each in found["findings"]] == ["Pairs D1 and A3 look swapped."]
    assert found["outliers"] == ["D1", "A3"]
    assert found["centre"] == pytest.approx([0.5, -6.0, 4.0], abs=1e-5)


def test_points_not_clicked_yet_are_told_where_to_expect(tmp_path: Path, lens: Path) -> None:
    rows = [f"{point.name},{100 * point.x},{100 * point.y}" for point in GRID]
    points = tmp_path / "points.csv"
    points.write_text("\n".join(["name,x,y", *rows]))
    pairs = clicks(CAMERA)
    few = [{"name": pairs[index].name, "pixel": pairs[index].pixel} for index in (0, 4, 20, 24)]
    file = tmp_path / "pairs.json"
    file.write_text(json.dumps({"pairs": few}))
    found = run_json(file, "--points", points, "--unit", "cm", "--lens", lens)
    assert len(found["expected"]) == 21
    expected = {each["name"]: (each["x"], each["y"]) for each in found["expected"]}
    assert expected["C3"] == pytest.approx(pairs[12].pixel, abs=0.01)


@pytest.mark.parametrize("kind", ["xml", "printed"])
def test_a_lens_comes_from_an_xml_or_from_what_was_printed(tmp_path: Path, kind: str) -> None:
    file = tmp_path / ("intr.xml" if kind == "xml" else "lens.json")
    if kind == "xml":
        file.write_bytes(intrinsic_xml(Intrinsic(LENS.matrix, LENS.distortion)))
    else:
        content = {"camera_matrix": LENS.matrix.tolist(), "distortion": LENS.distortion.tolist()}
        file.write_text(json.dumps(content))
    pairs = pair_file(tmp_path, clicks(CAMERA))
    found = run_json(pairs, "--lens", file, "--image-size", "1920x1080")
    assert found["centre"] == pytest.approx([0.5, -6.0, 4.0], abs=1e-4)


@pytest.mark.parametrize("count", [0, 3])
def test_too_few_pairs_are_refused_with_a_sentence(tmp_path: Path, lens: Path, count: int) -> None:
    with pytest.raises(CommandError, match=r"at least 4 pairs|holds no points|neither a list"):
        run(pair_file(tmp_path, clicks(CAMERA)[:count]), "--lens", lens)


def test_a_lens_that_is_none_is_refused_with_a_sentence(tmp_path: Path) -> None:
    file = tmp_path / "lens.json"
    file.write_text('{"camera_matrix": [[1, 2], [3]]}')
    with pytest.raises(CommandError, match="lens"):
        run(pair_file(tmp_path, clicks(CAMERA)), "--lens", file)


def test_of_several_cameras_one_must_be_chosen(tmp_path: Path) -> None:
    other = LENS.camera("C2", CAMERA.rvec, CAMERA.tvec)
    save_cameras(tmp_path / "cameras.json", [CAMERA, other])
    pairs = pair_file(tmp_path, clicks(CAMERA))
    with pytest.raises(CommandError, match="no camera C9; say which one: C1, C2"):
        run(pairs, "--lens", tmp_path / "cameras.json", "--camera", "C9")
    assert np.isfinite(run_json(pairs, "--lens", tmp_path / "cameras.json")["rms"])
