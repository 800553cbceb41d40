from __future__ import annotations

import io
import os
import zipfile
from pathlib import Path

import pytest

from gtm_hit.formats.stable_zip import write_folder_zip, write_zip


def zipped(files: dict[str, bytes | Path], compressed: bool = True) -> bytes:
    stream = io.BytesIO()
    write_zip(stream, files, compressed)
    return stream.getvalue()


def test_contents_come_back() -> None:
    with zipfile.ZipFile(io.BytesIO(zipped({"b/c.json": b"[]" * 1000, "a.txt": b"x"}))) as archive:
        assert archive.testzip() is None
        assert archive.namelist() == ["a.txt", "b/c.json"]
        assert archive.read("b/c.json") == b"[]" * 1000


@pytest.mark.parametrize("compressed", [True, False])
def test_order_times_and_permissions_do_not_change_the_bytes(tmp_path: Path, compressed: bool) -> None:
    archives = []
    for folder, names in [(tmp_path / "one", ("a", "b")), (tmp_path / "two", ("b", "a"))]:
        folder.mkdir()
        for name in names:
            (folder / name).write_bytes(name.encode() * 5000)
        archives.append(tmp_path / f"{folder.name}.zip")
    os.utime(tmp_path / "two" / "a", (0, 0))
    (tmp_path / "two" / "b").chmod(0o600)
    for folder, path in [("one", archives[0]), ("two", archives[1])]:
        write_folder_zip(path, tmp_path / folder, prefix="export", compressed=compressed)
    assert archives[0].read_bytes() == archives[1].read_bytes()


def test_a_file_and_its_bytes_give_the_same_archive(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"x" * 3_000_000)
    assert zipped({"a": tmp_path / "a"}) == zipped({"a": b"x" * 3_000_000})


def test_stored_bytes_are_the_same_on_every_machine() -> None:
    assert zipped({"a": b"x"}, compressed=False).hex() == (
        "504b0304140000000000000021008316dc8c0100000001000000010000006178"
        "504b01021403140000000000000021008316dc8c0100000001000000010000000000000000000000a4810000000061"
        "504b050600000000010001002f000000200000000000"
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


def test_a_failed_archive_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a\\b").write_bytes(b"x")
    with pytest.raises(ValueError):
        write_folder_zip(tmp_path / "out" / "a.zip", tmp_path / "in")
    assert list((tmp_path / "out").iterdir()) == []


def test_progress_is_told_by_file(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    write_zip(io.BytesIO(), {"a": b"", "b": b""}, progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 2), (2, 2)]
