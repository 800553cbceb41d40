"""The rooms of the browser's half know only the rooms below them, as those of the server do."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.conftest import REPOSITORY

STATIC = REPOSITORY / "static"
MAY_IMPORT: dict[str, set[str]] = {
    "base": set(),
    "geometry": set(),
    "truth": {"base", "geometry"},
    "saving": {"base", "tables", "truth"},
    "tables": {"base", "geometry", "truth"},
    "views": {"base", "geometry", "truth"},
    "workbench/keys": {"base"},
    "workbench/placing": {"base", "geometry", "truth", "views", "workbench/keys"},
    "workbench/people": {"base", "saving", "truth", "views", "workbench/keys"},
    "workbench/proposals": {"base", "truth", "views", "workbench/keys"},
    "workbench/sheet": {"base", "truth", "views", "workbench/keys"},
    "workbench/frames": {"base", "truth", "saving", "views", "workbench/keys"},
    "workbench/warnings": {"base", "truth", "views"},
    "workbench/comments": {"base", "truth", "views"},
    "workbench/tutorial": {"base", "truth", "views", "workbench/keys"},
    "compare": {"base", "tables", "truth", "views"},
    "review": {"base", "compare", "tables", "truth", "views"},
    "conflicts": {"base"},
    "calibration": {"base"},
    "calibration/check": {"base", "calibration", "geometry"},
    "calibration/ground": {"base", "calibration", "geometry"},
    "calibration/lens": {"base", "calibration"},
    "calibration/sync": {"base", "calibration"},
    "site": {"base"},
}
ABOVE = "workbench"  # builds the page from all of its rooms
IMPORT = re.compile(r"""^(?:import|export)\b[^;]*?\bfrom\s*"(\.[^"]+)";""", re.MULTILINE)
LATER = re.compile(r"""import(?:\.meta\.resolve)?\(\s*"(\.[^"]+\.js)"\s*\)""")
COMMENT = re.compile(r"/\*.*?\*/|^\s*//[^\n]*", re.DOTALL | re.MULTILINE)

FILES = sorted(file for file in STATIC.rglob("*.js") if "vendor" not in file.parts)


def room_of(file: Path) -> str:
    return str(file.relative_to(STATIC).parent)


def imports_of(file: Path) -> set[Path]:
    code = COMMENT.sub("", file.read_text(encoding="utf-8"))
    return {(file.parent / name).resolve() for name in IMPORT.findall(code) + LATER.findall(code)}


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(STATIC)))
def test_a_module_imports_only_from_rooms_below(file: Path) -> None:
    room = room_of(file)
    if room == ABOVE:
        return
    for imported in imports_of(file):
        assert room_of(imported) in MAY_IMPORT[room] | {room}, f"{room} must not know {room_of(imported)}"


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(STATIC)))
def test_every_imported_module_exists(file: Path) -> None:
    assert [imported for imported in imports_of(file) if not imported.is_file()] == []
