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
        ("SCRIPT_NAME", "gtm"),
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


def variables_of_compose() -> set[str]:
    compose = (ROOT / "docker-compose.yml").read_text(encoding="utf-8")
    block = compose.split("environment: &environment", 1)[1].split("volumes:", 1)[0]
    return set(re.findall(r"^    ([A-Z_]+):", block, re.MULTILINE))


def test_every_variable_reaches_the_containers() -> None:
    assert variables_of_compose() == variables_read()


def test_defaults_of_compose_are_those_of_the_example() -> None:
    compose = (ROOT / "docker-compose.yml").read_text(encoding="utf-8")
    example = (ROOT / ".env.example").read_text(encoding="utf-8")
    defaults = dict(re.findall(r"^([A-Z_]+)=(.*)$", example, re.MULTILINE))
    handed_on = re.findall(r"\$\{([A-Z_]+):-([^}]*)\}", compose)
    assert {"MAX_UPLOAD_MB", "LOG_LEVEL", "TUTORIAL_DATASET", "DEBUG"} <= {name for name, _ in handed_on}
    different = {(name, value) for name, value in handed_on if value != defaults.get(name, value)}
    # In containers, the proxy is known: it has an address of the network that compose makes.
    assert different <= {("ALLOWED_HOSTS", "localhost"), ("TRUSTED_PROXIES", "172.16.0.0/12")}


def test_the_proxy_takes_the_limit_of_uploads_from_the_same_variable() -> None:
    assert "client_max_body_size ${MAX_UPLOAD_MB}m;" in (ROOT / "deploy" / "nginx.conf").read_text()


PASSWORD = "p@ss/w:o#r?d%41"


def database(**variables: str) -> str:
    code = (
        "from django.conf import settings; d=settings.DATABASES['default']; print(d['HOST'], d['PASSWORD'])"
    )
    return subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT,
        env={"PATH": os.environ["PATH"], "DJANGO_SETTINGS_MODULE": "annotator.settings", **variables},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()


def test_a_password_apart_from_the_address_may_have_any_character() -> None:
    url = "postgres://gtm@postgres:5432/gtm"
    found = database(SECRET_KEY="s" * 50, DATABASE_URL=url, DATABASE_PASSWORD=PASSWORD)
    assert found == f"postgres {PASSWORD}"


@pytest.mark.parametrize("password", ["p@ss", "p@ss/w", "p/ss", "p#ss", "p?ss"])
def test_a_password_that_breaks_its_address_stops_the_start(password: str) -> None:
    result = start(SECRET_KEY="s" * 50, DATABASE_URL=f"postgres://gtm:{password}@postgres:5432/gtm")
    assert result.returncode != 0
    assert "DATABASE_URL" in result.stderr.strip().splitlines()[-1]


def test_djangos_own_checks_for_production_find_nothing(tmp_path: Path) -> None:
    key = "0123456789-abcdefghijklmnopqrstuvwxyz-ABCDEFGHIJKLMNOP"
    result = manage("check", "--deploy", SECRET_KEY=key, SECURE="true", DATA_DIR=str(tmp_path / "data"))
    assert result.stdout.startswith("System check identified no issues"), result.stderr


def test_acknowledged_saves_are_written_through_to_the_disk(tmp_path: Path) -> None:
    code = (
        "from django.db import connection; cursor = connection.cursor();"
        " cursor.execute('PRAGMA synchronous'); print(cursor.fetchone())"
    )
    result = manage("shell", "-v0", "-c", code, SECRET_KEY="s" * 50, DATA_DIR=str(tmp_path / "data"))
    assert result.stdout.strip() == "(2,)"  # FULL


@pytest.mark.parametrize("name", ["manage.py", "annotator.wsgi"])
def test_nobody_else_may_look_into_the_data_folder(tmp_path: Path, name: str) -> None:
    data = tmp_path / "data"
    data.mkdir(mode=0o755)
    (data / "gtm.sqlite3").touch(0o644)
    if name == "manage.py":
        manage("migrate", "-v0", SECRET_KEY="s" * 50, DATA_DIR=str(data))
    else:
        environment = {"PATH": os.environ["PATH"], "SECRET_KEY": "s" * 50, "DATA_DIR": str(data)}
        subprocess.run([sys.executable, "-c", f"import {name}"], cwd=ROOT, env=environment, check=True)
    assert data.stat().st_mode & 0o777 == 0o700
    assert (data / "gtm.sqlite3").stat().st_mode & 0o777 == 0o600


def test_links_that_commands_print_lie_below_the_path(tmp_path: Path) -> None:
    code = "from django.urls import reverse; print(reverse('join', args=['x']))"
    result = manage(
        "shell", "-v0", "-c", code, SECRET_KEY="s" * 50, SCRIPT_NAME="/gtm", DATA_DIR=str(tmp_path / "data")
    )
    assert result.stdout.strip() == "/gtm/join/x/"
