#!/usr/bin/env python
from __future__ import annotations

import os
import secrets
import sys
from pathlib import Path

from annotator.private_files import keep_private, private_folder

PURE = {"evaluate"}  # compares files: needs neither a key nor a data folder
# Their files are for others, wherever they are told to put them.
FOR_OTHERS = {"exportlayer", "exportpom", "statistics", "comparelayers"}


def main() -> None:
    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    provide_key()
    from django.conf import settings
    from django.core.exceptions import ImproperlyConfigured
    from django.core.management import execute_from_command_line

    try:
        if sys.argv[1:2] and sys.argv[1] not in {*PURE, "help", "--help", "--version"}:
            # SQLite makes its file, but not the folder around it.
            (private_folder if sys.argv[1] in FOR_OTHERS else keep_private)(settings.DATA_DIR)
            Path(settings.FILE_UPLOAD_TEMP_DIR).mkdir(exist_ok=True)
    except ImproperlyConfigured as error:
        sys.exit(str(error))
    except OSError as error:
        sys.exit(f"DATA_DIR {error.filename} cannot be made: {error.strerror}")
    execute_from_command_line(sys.argv)


def provide_key() -> None:
    """Commands typed beside a local start use its key; a pure one signs nothing, so any key will do."""
    if os.environ.get("SECRET_KEY"):
        return
    kept = Path(os.environ.get("DATA_DIR") or Path(__file__).resolve().parent / "var") / "secret-key"
    if PURE & set(sys.argv[1:2]):
        os.environ["SECRET_KEY"] = secrets.token_urlsafe(48)
    elif kept.is_file() and not os.environ.get("DEBUG"):
        os.environ["SECRET_KEY"] = kept.read_text(encoding="utf-8").strip()


if __name__ == "__main__":
    main()
