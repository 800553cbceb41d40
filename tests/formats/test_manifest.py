from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.formats.manifest import (
    FileEntry,
    Manifest,
    manifest_json,
    parse_manifest,
    read_manifest,
    verify,
    write_manifest,
)
from gtm_hit.formats.problems import FormatError

DIGEST = "7692c3ad3540bb803c020b3aee66cd8887123234ea0c6e7143c0add73ff431ed"  # what sha256sum says of "one"
OTHER = hashlib.sha256(b"two").hexdigest()


@pytest.fixture
def export(tmp_path: Path) -> Path:
    (tmp_path / "annotations_positions").mkdir()
    (tmp_path / "annotations_positions" / "00000000.json").write_bytes(b"one")
    (tmp_path / "README.txt").write_bytes(b"two")
    files = {"annotations_positions/00000000.json": FileEntry(3, DIGEST), "README.txt": FileEntry(3, OTHER)}
    write_manifest(tmp_path, Manifest({"people": 24}, {"radius": 0.16}, files))
    return tmp_path


def test_counts_parameters_and_files_are_read(export: Path) -> None:
    manifest = read_manifest(export)
    assert list(manifest.files) == ["README.txt", "annotations_positions/00000000.json"]
    assert manifest.files["annotations_positions/00000000.json"] == FileEntry(3, DIGEST)
    assert manifest.counts == {"people": 24}
    assert manifest.parameters == {"radius": 0.16}


def test_a_manifest_comes_back(export: Path) -> None:
    manifest = read_manifest(export)
    assert parse_manifest(manifest_json(manifest), "a") == manifest


def test_the_order_of_insertion_does_not_change_the_bytes() -> None:
    one = Manifest({"a": 1, "b": 2}, {}, {"x": FileEntry(1, DIGEST), "y": FileEntry(2, DIGEST)})
    other = Manifest({"b": 2, "a": 1}, {}, {"y": FileEntry(2, DIGEST), "x": FileEntry(1, DIGEST)})
    assert manifest_json(one) == manifest_json(other)


def test_a_number_json_does_not_have_is_not_written() -> None:
    with pytest.raises(ValueError):
        manifest_json(Manifest({}, {"radius": float("nan")}))


def test_an_untouched_export_verifies(export: Path) -> None:
    assert verify(export) == []


def test_a_changed_file_is_told_even_when_its_size_is_the_same(export: Path) -> None:
    (export / "README.txt").write_bytes(b"owt")
    assert list(map(str, verify(export))) == ["README.txt: is not the file the manifest was made of"]


def test_missing_and_surplus_files_are_told(export: Path) -> None:
    (export / "README.txt").rename(export / "LICENCE.txt")
    assert list(map(str, verify(export))) == ["README.txt: is missing", "LICENCE.txt: is not in the manifest"]


def test_a_folder_without_a_manifest_does_not_verify(tmp_path: Path) -> None:
    assert "no such file" in str(verify(tmp_path)[0])


@pytest.mark.parametrize("name", ["/etc/passwd", "../x", "a/../../x", "a//b", "./a", "", "."])
def test_a_path_that_leaves_the_folder_is_refused(name: str) -> None:
    data = manifest_json(Manifest({}, {}, {name: FileEntry(1, DIGEST)}))
    with pytest.raises(FormatError, match="not a path below the folder"):
        parse_manifest(data, "a")


@pytest.mark.parametrize(
    "entry", [None, 3, {}, {"bytes": True, "sha256": DIGEST}, {"bytes": 1, "sha256": "x" * 64}]
)
def test_an_entry_without_size_and_digest_is_refused(entry: object) -> None:
    content = {"version": 1, "counts": {}, "parameters": {}, "files": {"a": entry}}
    with pytest.raises(FormatError, match="instead of"):
        parse_manifest(json.dumps(content).encode(), "a")


def test_another_version_is_refused() -> None:
    with pytest.raises(FormatError, match="version: is 2 instead of 1"):
        parse_manifest(b'{"version": 2, "counts": {}, "parameters": {}, "files": {}}', "a")


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)
names = st.sampled_from(["version", "counts", "parameters", "files"])


@given(
    st.binary(max_size=100)
    | st.dictionaries(names, json_values | st.just(1)).map(lambda each: json.dumps(each).encode())
)
def test_any_bytes_are_either_read_or_refused(data: bytes) -> None:
    try:
        parse_manifest(data, "a")
    except FormatError as error:
        assert error.problems
