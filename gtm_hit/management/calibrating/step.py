"""What a part of `manage.py calibrate` is."""

from __future__ import annotations

from argparse import ArgumentParser
from collections.abc import Callable
from typing import Any, Protocol


class Step(Protocol):
    """A module of this folder: one subcommand, of files alone, without a database."""

    HELP: str

    def add_arguments(self, parser: ArgumentParser) -> None: ...

    def run(self, options: dict[str, Any], say: Callable[[str], object]) -> dict[str, Any]:
        """Do it, saying how it goes; what is returned is printed by `--json`. Raises CommandError."""
        ...
