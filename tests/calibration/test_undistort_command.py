from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from django.core.management import CommandError, call_command

from gtm_hit.formats.calibration.cameras_json import save_cameras
from gtm_hit.formats.calibration.wildtrack_xml import Intrinsic, intrinsic_xml
from gtm_hit.geometry.camera import beyond_fold, normalise
from tests.calibration.clicked import LENS, standing


@pytest.fixture
def lens(tmp_path: Path) -> Path:
    save_cameras(tmp_path / "cameras.json", [standing()])
    return tmp_path / "cameras.json"


@pytest.fixture
def pictures(tmp_path: Path) -> Path:
    """One with a white spot at (300, 200), as taken; one grey of 16 bits."""
    folder = tmp_path / "taken"
    folder.mkdir()
    picture = np.zeros((1080, 1920, 3), np.uint8)
    picture[195:206, 295:306] = 255
    cv2.imwrite(str(folder / "a.png"), picture)
    cv2.imwrite(str(folder / "b.png"), np.full((1080, 1920), 40_000, np.uint16))
    return folder


def run(*words: object) -> dict[str, Any]:
    out = io.StringIO()
    call_command("calibrate", "undistort", *map(str, words), "--json", stdout=out, stderr=io.StringIO())
    found: dict[str, Any] = json.loads(out.getvalue())
    return found


@pytest.mark.parametrize("alpha", [(), ("--alpha", "0"), ("--alpha", "1")])
def test_what_is_seen_moves_where_the_told_matrix_has_it(
    tmp_path: Path, lens: Path, pictures: Path, alpha: tuple[str, ...]
) -> None:
    found = run(pictures, tmp_path / "out", "--lens", lens, *alpha)
    assert found["pictures"] == 2
    white = np.argwhere(cv2.imread(str(tmp_path / "out/a.png"), cv2.IMREAD_GRAYSCALE) > 128)
    (direction,) = normalise(standing(), [(300.0, 200.0)])
    expected = np.array(found["camera_matrix"])[:2] @ [*direction, 1.0]
    assert white.mean(axis=0)[::-1] == pytest.approx(expected, abs=0.5)


def test_grey_stays_grey_and_16_bits_stay_16_bits(tmp_path: Path, lens: Path, pictures: Path) -> None:
    run(pictures, tmp_path / "out", "--lens", lens, "--alpha", "0")
    picture = cv2.imread(str(tmp_path / "out/b.png"), cv2.IMREAD_UNCHANGED)
    assert (picture.dtype, picture.shape) == (np.uint16, (1080, 1920))
    assert (picture == 40_000).all()


def test_black_pixels_are_counted(tmp_path: Path, lens: Path, pictures: Path) -> None:
    found = run(pictures, tmp_path / "out", "--lens", lens, "--alpha", "1")
    picture = cv2.imread(str(tmp_path / "out/b.png"), cv2.IMREAD_UNCHANGED)
    assert found["black_pixels"] == pytest.approx((picture < 20_000).sum(), rel=0.02)
    assert found["folded_pixels"] == 0


def test_pixels_before_which_the_lens_folds_are_black_and_counted(tmp_path: Path) -> None:
    folding = replace(standing(), distortion=np.array([-0.6, 0.0, 0.0, 0.0, 0.0]))
    save_cameras(tmp_path / "cameras.json", [folding])
    cv2.imwrite(str(tmp_path / "white.png"), np.full((1080, 1920), 255, np.uint8))
    found = run(tmp_path / "white.png", tmp_path / "out", "--lens", tmp_path / "cameras.json", "--alpha", "1")
    folded = beyond_fold(folding, np.array(found["camera_matrix"]))
    picture = cv2.imread(str(tmp_path / "out/white.png"), cv2.IMREAD_GRAYSCALE)
    assert found["folded_pixels"] == folded.sum() > 10_000
    assert picture[folded].max() == 0
    assert found["black_pixels"] >= found["folded_pixels"]


def test_pictures_of_another_size_are_refused_and_nothing_is_written(
    tmp_path: Path, lens: Path, pictures: Path
) -> None:
    cv2.imwrite(str(pictures / "c.png"), np.zeros((480, 640), np.uint8))
    with pytest.raises(CommandError, match=r"c\.png: 640×480 pixels, but the lens is for 1920×1080"):
        run(pictures, tmp_path / "out", "--lens", lens)
    assert not (tmp_path / "out").exists()


def test_pictures_are_never_overwritten(tmp_path: Path, lens: Path, pictures: Path) -> None:
    before = (pictures / "a.png").read_bytes()
    with pytest.raises(CommandError, match="choose another folder"):
        run(pictures, pictures, "--lens", lens)
    assert (pictures / "a.png").read_bytes() == before


@pytest.mark.parametrize("words", [("--alpha", "2"), ("--alpha", "nan")])
def test_another_alpha_is_refused(tmp_path: Path, lens: Path, pictures: Path, words: tuple[str, ...]) -> None:
    with pytest.raises(CommandError, match="from 0 to 1"):
        run(pictures, tmp_path / "out", "--lens", lens, *words)


def test_what_is_no_picture_is_refused_by_name(tmp_path: Path, lens: Path) -> None:
    (tmp_path / "broken.png").write_bytes(b"nothing")
    with pytest.raises(CommandError, match=r"broken\.png: not a picture"):
        run(tmp_path / "broken.png", tmp_path / "out", "--lens", lens)
    (tmp_path / "empty").mkdir()
    with pytest.raises(CommandError, match="no PNG or JPEG there"):
        run(tmp_path / "empty", tmp_path / "out", "--lens", lens)


def test_the_size_of_an_xml_lens_is_that_of_the_pictures(tmp_path: Path, pictures: Path) -> None:
    (tmp_path / "intr.xml").write_bytes(intrinsic_xml(Intrinsic(LENS.matrix, LENS.distortion)))
    assert run(pictures, tmp_path / "out", "--lens", tmp_path / "intr.xml")["image_size"] == [1920, 1080]
