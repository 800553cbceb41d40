"""docs/three-ways.md names what there is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from django.core.management import get_commands
from django.urls import Resolver404, resolve

TABLE = (Path(__file__).resolve().parent.parent / "docs" / "three-ways.md").read_text(encoding="utf-8")
LINES = [line for line in TABLE.splitlines() if line.startswith("|")]
ROWS = [[cell.strip() for cell in line.strip("|").split("|")] for line in LINES]

KNOWN = {
    "S": "square",
    "L": "truth",
    "N": "1",
    "J": "1",
    "R": "1",
    "C": "walk",
    "W": "w-1",
    "D": "plaza",
    "K": "C1",
    "NAME": "LICENSE",
}
SHORTENED = {"statistics": "datasets/square/layers/truth", "evaluation": "datasets/square"}


def words(column: int) -> list[str]:
    """What stands in code in a column, one address or command each."""
    found = [code for row in ROWS[2:] for code in re.findall(r"`([^`]+)`", row[column])]
    return [re.sub(r"^(GET|POST|PATCH) ", "", code) for code in found if code not in {"GET", "POST", "pom"}]


def address(code: str) -> str:
    """With names for the letters, and what `…` leaves out."""
    path = "/".join(KNOWN.get(part, part) for part in code.split("/"))
    for shortened, before in SHORTENED.items():
        path = path.replace(f"…/{shortened}", f"{before}/{shortened}")
    return path.replace("…/", "datasets/square/evaluation/")


@pytest.mark.parametrize("code", [code for code in words(1) if "/" in code])
def test_every_page_is_there(code: str) -> None:
    resolve("/" + address(code))


@pytest.mark.parametrize("code", [code for code in words(2) if "/" in code])
def test_every_address_is_there(code: str) -> None:
    try:
        view = resolve("/api/v1/" + address(code)).func
    except Resolver404:
        pytest.fail(f"{code} is no address")
    assert view.__name__ != "MissingView", code


def test_every_command_is_there() -> None:
    named = {code.split()[0] for code in words(3) if code[0] != "-"}
    assert named - set(get_commands()) == set()
