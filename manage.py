#!/usr/bin/env python
from __future__ import annotations

import os
import secrets
import sys
from pathlib import Path


def main() -> None:
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    provide_key()
    from django.core.management import execute_from_command_line

    execute_from_command_line(sys.argv)


def provide_key() -> None:
    """Commands typed beside a local start use its key; `evaluate` signs nothing, so any key will do."""
    if os.environ.get("SECRET_KEY"):
        return
    kept = Path(os.environ.get("DATA_DIR") or Path(__file__).resolve().parent / "var") / "secret-key"
    if sys.argv[1:2] == ["evaluate"]:
        os.environ["SECRET_KEY"] = secrets.token_urlsafe(48)
    elif kept.is_file() and not os.environ.get("DEBUG"):
        os.environ["SECRET_KEY"] = kept.read_text(encoding="utf-8").strip()


if __name__ == "__main__":
    main()
