"""What lies below DATA_DIR is for the account that runs the server alone: sessions, keys, faces."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

OURS_ALONE = 0o077  # what nobody else may


def private_folder(data: Path) -> None:
    """Make the folder; what was made with wider rights before is closed.

    Its own rights keep others out of everything below, so only what lies directly in it is looked at as well.
    """
    data.mkdir(mode=0o700, parents=True, exist_ok=True)
    for path in (data, *data.iterdir()):
        # A mounted volume may belong to somebody else, and a temporary file may be gone.
        with suppress(PermissionError, FileNotFoundError):
            if not path.is_symlink() and path.stat().st_mode & OURS_ALONE:
                path.chmod(0o700 if path.is_dir() else 0o600)


def keep_private(data: Path) -> None:
    """For processes that write there and nowhere else."""
    os.umask(OURS_ALONE)
    private_folder(data)
