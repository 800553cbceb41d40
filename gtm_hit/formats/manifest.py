"""What an export holds: counts, the parameters it was made with, and the SHA-256 of every file."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from gtm_hit.formats.files import read_source, reason_of, write_bytes
from gtm_hit.formats.problems import FormatError, Problem, ProblemList, shown
from gtm_hit.formats.strict_json import parse_json

MANIFEST_NAME = "manifest.json"
MOST_BYTES = 256_000_000
VERSION = 1


@dataclass(frozen=True)
class FileEntry:
    size: int
    sha256: str


@dataclass(frozen=True)
class Manifest:
    """`files` is by path below the folder, with slashes; `counts` and `parameters` are plain JSON values."""

    counts: Mapping[str, int]
    parameters: Mapping[str, Any]
    files: Mapping[str, FileEntry] = field(default_factory=dict)


def manifest_json(manifest: Manifest) -> bytes:
    """The same manifest always gives the same bytes; raises ValueError for values JSON does not have."""
    content = {
        "version": VERSION,
        "counts": dict(manifest.counts),
        "parameters": dict(manifest.parameters),
        "files": {name: {"bytes": each.size, "sha256": each.sha256} for name, each in manifest.files.items()},
    }
    text = json.dumps(content, indent=2, sort_keys=True, ensure_ascii=False, allow_nan=False)
    return (text + "\n").encode()


def write_manifest(folder: Path, manifest: Manifest) -> Path:
    path = folder / MANIFEST_NAME
    write_bytes(path, manifest_json(manifest))
    return path


def read_manifest(folder: Path) -> Manifest:
    """Raises FormatError when the folder has no manifest or it is not one."""
    path = folder / MANIFEST_NAME
    return parse_manifest(read_source(path, MOST_BYTES), str(path))


def parse_manifest(data: bytes, path: str) -> Manifest:
    problems = ProblemList(path)
    content = parse_json(data, path)
    parts = content if isinstance(content, dict) else {}
    if parts.get("version") != VERSION:
        problems.add("version", f"is {shown(parts.get('version'))} instead of {VERSION}")
    for name in ("counts", "parameters", "files"):
        if not isinstance(parts.get(name), dict):
            problems.add(name, f"is {shown(parts.get(name))} instead of an object")
    problems.raise_if_any()
    for name, count in parts["counts"].items():
        if type(count) is not int:
            problems.add("counts", f"{shown(name)} is {shown(count)} instead of an integer")
    files = {name: _parse_entry(name, entry, problems) for name, entry in parts["files"].items()}
    problems.raise_if_any()
    return Manifest(parts["counts"], parts["parameters"], files)


def verify(folder: Path) -> list[Problem]:
    """What differs between a folder and its manifest: files missing, changed, surplus; empty if nothing."""
    try:
        manifest = read_manifest(folder)
    except FormatError as error:
        return list(error.problems)
    names = set(_names(folder))
    problems = [Problem(name, "", "is missing") for name in sorted(manifest.files.keys() - names)]
    problems += [
        Problem(name, "", "is not in the manifest") for name in sorted(names - manifest.files.keys())
    ]
    for name in sorted(names & manifest.files.keys()):
        try:
            if _entry(folder / name) != manifest.files[name]:
                problems.append(Problem(name, "", "is not the file the manifest was made of"))
        except OSError as error:
            problems.append(Problem(name, "", f"cannot be read: {reason_of(error)}"))
    return problems


def _names(folder: Path) -> list[str]:
    paths = (path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    return sorted(name for name in paths if name != MANIFEST_NAME)


def _entry(path: Path) -> FileEntry:
    with path.open("rb") as stream:
        digest = hashlib.file_digest(stream, "sha256").hexdigest()
        return FileEntry(stream.tell(), digest)


def _parse_entry(name: str, entry: Any, problems: ProblemList) -> FileEntry:
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts or str(path) != name or name == ".":
        problems.add("files", f"{shown(name)} is not a path below the folder")
    size, digest = (
        (entry.get(key) for key in ("bytes", "sha256")) if isinstance(entry, dict) else (None, None)
    )
    if type(size) is not int or size < 0:
        problems.add(f"files, {shown(name)}", f"bytes is {shown(size)} instead of a size")
        size = 0
    if not isinstance(digest, str) or len(digest) != 64 or set(digest) - set("0123456789abcdef"):
        problems.add(f"files, {shown(name)}", f"sha256 is {shown(digest)} instead of 64 hexadecimal digits")
    return FileEntry(size, str(digest))
