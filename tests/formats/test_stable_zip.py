from __future__ import annotations

import io
import os
import tempfile
import zipfile
from pathlib import Path

import pytest

from gtm_hit.formats import stable_zip as module
from gtm_hit.formats.stable_zip import stable_zip


def zipped(files: dict[str, bytes | Path], prefix: str = "") -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.zip"
        with stable_zip(path, prefix) as archive:
            for name, source in files.items():
                archive.add(name, source)
        return path.read_bytes()


def test_contents_come_back() -> None:
    with zipfile.ZipFile(
        io.BytesIO(zipped({"b/c.json": b"[]" * 1000, "a.txt": b"x"}, prefix="out"))
    ) as archive:
        assert archive.testzip() is None
        assert archive.namelist() == ["out/b/c.json", "out/a.txt"]
        assert archive.read("out/b/c.json") == b"[]" * 1000


@pytest.mark.parametrize("inside", ["a.txt", "a.png"], ids=["compressed", "stored"])
def test_times_and_permissions_do_not_change_the_bytes(tmp_path: Path, inside: str) -> None:
    for name in ("one", "two"):
        (tmp_path / name).write_bytes(b"a" * 5000)
    os.utime(tmp_path / "two", (0, 0))
    (tmp_path / "two").chmod(0o600)
    first, second = (zipped({inside: tmp_path / name}) for name in ("one", "two"))
    assert first == second


def test_many_more_files_than_wait_at_once_come_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_BYTES_TOGETHER", 10)
    files: dict[str, bytes | Path] = {str(number): b"%d" % number * 8 for number in range(100)}
    with zipfile.ZipFile(io.BytesIO(zipped(files))) as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == files


def test_a_name_cannot_be_there_twice(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="there twice"), stable_zip(tmp_path / "a.zip") as archive:
        archive.add("a", b"x")
        archive.add("a", b"x")


def test_a_file_and_its_bytes_give_the_same_archive(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"x" * 3_000_000)
    assert zipped({"a": tmp_path / "a"}) == zipped({"a": b"x" * 3_000_000})


def test_stored_bytes_are_the_same_on_every_machine() -> None:
    assert zipped({"a.gz": b"x"}).hex() == (
        "504b0304140000000000000021008316dc8c010000000100000004000000612e677a78"
        "504b01021403140000000000000021008316dc8c0100000001000000040000000000000000000000a48100000000612e677a"
        "504b0506000000000100010032000000230000000000"
    )


def test_unpacked_files_can_be_read_by_others() -> None:
    with zipfile.ZipFile(io.BytesIO(zipped({"a": b"x"}))) as archive:
        assert archive.getinfo("a").external_attr >> 16 == 0o100644


def test_images_are_not_compressed_again() -> None:
    with zipfile.ZipFile(io.BytesIO(zipped({"a.png": b"x" * 999, "a.json": b"x" * 999}))) as archive:
        assert archive.getinfo("a.png").compress_type == zipfile.ZIP_STORED
        assert archive.getinfo("a.json").compress_type == zipfile.ZIP_DEFLATED


@pytest.mark.parametrize("name", ["/etc/passwd", "../a", "a/../../b", "a\\b", "a//b", "", "."])
def test_a_name_that_leaves_the_folder_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match="not a path below a folder"):
        zipped({name: b"x"})


@pytest.mark.parametrize("together", [0, 1 << 20])
def test_a_failed_archive_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, together: int
) -> None:
    monkeypatch.setattr(module, "_BYTES_TOGETHER", together)
    with pytest.raises(FileNotFoundError), stable_zip(tmp_path / "out" / "a.zip") as archive:
        archive.add("a", tmp_path / "gone")
        for number in range(20):
            archive.add(str(number), b"x")
    assert list((tmp_path / "out").iterdir()) == []


def test_an_archive_given_up_leaves_nothing_behind(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), stable_zip(tmp_path / "out" / "a.zip") as archive:
        archive.add("a", b"x")
        raise KeyboardInterrupt
    assert list((tmp_path / "out").iterdir()) == []
