from __future__ import annotations

import os
from pathlib import Path

import pytest

from gtm_hit.formats.files import read_source, replacing, write_bytes
from gtm_hit.formats.problems import FormatError
from tests.disk_events import recorded


def test_a_source_is_read_whole(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"12345")
    assert read_source(tmp_path / "a", 5) == b"12345"


def test_a_source_above_the_limit_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"123456")
    with pytest.raises(FormatError, match="larger than 5 bytes"):
        read_source(tmp_path / "a", 5)


def test_an_empty_source_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    with pytest.raises(FormatError, match="the file is empty"):
        read_source(tmp_path / "a", 5)


def test_a_missing_source_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no such file"):
        read_source(tmp_path / "a", 5)


def test_a_named_pipe_is_refused_without_waiting(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a")
    with pytest.raises(FormatError, match="not a plain file"):
        read_source(tmp_path / "a", 5)


def test_a_name_with_a_zero_byte_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError):
        read_source(tmp_path / "a\x00b", 5)


def test_written_bytes_appear_under_the_name_and_nothing_else_remains(tmp_path: Path) -> None:
    write_bytes(tmp_path / "deep" / "a", b"new")
    assert (tmp_path / "deep" / "a").read_bytes() == b"new"
    assert [path.name for path in (tmp_path / "deep").iterdir()] == ["a"]


def test_a_failed_write_leaves_the_old_file_and_no_temporary_one(tmp_path: Path) -> None:
    write_bytes(tmp_path / "a", b"old")
    with pytest.raises(RuntimeError), replacing(tmp_path / "a") as stream:
        stream.write(b"half")
        raise RuntimeError
    assert (tmp_path / "a").read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_written_file_can_be_read_by_others(tmp_path: Path) -> None:
    write_bytes(tmp_path / "a", b"x")
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o644


def test_bytes_are_on_the_disk_before_their_name_and_the_name_before_the_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    events = recorded(monkeypatch)
    write_bytes(tmp_path / "new" / "a", b"x")
    (made, folder), (first, temporary), *rest = events
    assert (made, folder) == ("sync", tmp_path)  # the new folder's own name
    assert first == "sync" and temporary.name.startswith(".a.")
    assert rest == [("rename", tmp_path / "new" / "a"), ("sync", tmp_path / "new")]
