"""What production serves: hashed names, whole files, every import found."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import REPOSITORY

OURS = (
    *("base/", "calibration/", "compare/", "conflicts/", "geometry/", "review/", "saving/", "site/"),
    *("tables/", "truth/", "views/", "workbench/"),
)
IMPORT = re.compile(r"""(?:from|import|import\.meta\.resolve)\s*\(?["'](\.[^"']+)["']""")


@pytest.fixture(scope="module")
def collected(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The static files as production collects them, in a process with the product's settings."""
    data = tmp_path_factory.mktemp("data")
    environment = {"PATH": os.environ["PATH"], "SECRET_KEY": "s" * 50, "DATA_DIR": str(data)}
    command = [sys.executable, "manage.py", "collectstatic", "--noinput", "--verbosity", "0"]
    subprocess.run(command, cwd=REPOSITORY, env=environment, check=True)
    return data / "static"


def our_files(collected: Path) -> dict[str, Path]:
    """Hashed files by the name they have in the repository."""
    names = json.loads((collected / "staticfiles.json").read_text(encoding="utf-8"))["paths"]
    return {name: collected / hashed for name, hashed in names.items() if name.startswith(OURS)}


def test_no_file_is_lost_or_emptied(collected: Path) -> None:
    files = our_files(collected)
    assert set(files) == {
        str(file.relative_to(REPOSITORY / "static"))
        for folder in OURS
        for file in (REPOSITORY / "static" / folder).rglob("*")
        if file.is_file()
    }
    assert not [name for name, file in files.items() if file.stat().st_size == 0]


def test_every_module_imports_modules_by_their_hashed_names(collected: Path) -> None:
    hashed = set(our_files(collected).values())
    for file in hashed:
        if file.suffix == ".js":
            for name in IMPORT.findall(file.read_text(encoding="utf-8")):
                assert (file.parent / name).resolve() in hashed, f"{file.name} imports {name}"
