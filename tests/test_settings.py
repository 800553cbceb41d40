from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
VARIABLE = re.compile(r'environment\.\w+\(\s*"([A-Z_]+)"')


def start(**variables: str) -> subprocess.CompletedProcess[str]:
    """Start Django in a process of its own with nothing but these variables."""
    environment = {"PATH": os.environ["PATH"], "DJANGO_SETTINGS_MODULE": "annotator.settings", **variables}
    code = "import django; django.setup(); from django.conf import settings; print(settings.DEBUG)"
    return subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )


def test_it_starts_with_a_secret_key_alone() -> None:
    assert start(SECRET_KEY="s" * 50).stdout.strip() == "False"


def test_there_is_no_built_in_secret_key_with_debug_off() -> None:
    result = start()
    assert result.returncode != 0
    assert "SECRET_KEY must be set" in result.stderr


def test_debug_brings_its_own_key() -> None:
    assert start(DEBUG="true").stdout.strip() == "True"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("DEBUG", "perhaps"),
        ("SECRET_KEY", "short"),
        ("DATABASE_URL", "mysql://somewhere/x"),
        ("DATABASE_URL", "postgres://u:p@host:notaport/x"),
        ("LEASE_MINUTES", "soon"),
        ("LEASE_MINUTES", "0"),
        ("SECURE", "maybe"),
        ("LOG_LEVEL", "LOUD"),
        ("CELERY_BROKER_URL", "amqp//"),
    ],
)
def test_a_wrong_value_stops_the_start_and_names_the_variable(name: str, value: str) -> None:
    result = start(**{"SECRET_KEY": "s" * 50, name: value})
    assert result.returncode != 0
    assert name in result.stderr.strip().splitlines()[-1]


def manage(*arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "manage.py", *arguments],
        cwd=ROOT,
        env={"PATH": os.environ["PATH"], **variables},
        capture_output=True,
        text=True,
        check=False,
    )


def test_a_command_makes_its_data_folder(tmp_path: Path) -> None:
    result = manage("migrate", "-v0", SECRET_KEY="s" * 50, DATA_DIR=str(tmp_path / "new" / "data"))
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "new" / "data" / "gtm.sqlite3").is_file()


def test_a_wrong_setting_is_told_in_one_line(tmp_path: Path) -> None:
    result = manage("migrate", DATA_DIR=str(tmp_path))
    assert result.returncode != 0
    assert result.stderr == "SECRET_KEY must be set (see .env.example)\n"


def test_a_data_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    result = manage("migrate", SECRET_KEY="s" * 50, DATA_DIR=str(tmp_path / "file" / "data"))
    assert result.returncode != 0
    assert str(tmp_path / "file" / "data") in result.stderr
    assert len(result.stderr.splitlines()) == 1


def variables_read() -> set[str]:
    return set(VARIABLE.findall((ROOT / "annotator" / "settings.py").read_text(encoding="utf-8")))


def test_every_variable_stands_in_the_example_file() -> None:
    named = re.findall(r"^([A-Z_]+)=", (ROOT / ".env.example").read_text(encoding="utf-8"), re.MULTILINE)
    assert set(named) == variables_read()


def test_every_variable_stands_in_the_readme() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert not [name for name in variables_read() if f"| `{name}`" not in readme]
