"""Celery's broker in a folder: Kombu's transport, with two things made safe for daily use."""

from __future__ import annotations

import uuid
from pathlib import Path
from time import time_ns
from typing import Any

from kombu.transport import filesystem
from kombu.utils.json import dumps


class Channel(filesystem.Channel):
    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        for folder in (self.data_folder_in, self.data_folder_out, self.control_folder):
            Path(folder).mkdir(parents=True, exist_ok=True)

    def _put(self, queue: str, payload: dict[str, Any], **kwargs: Any) -> None:  # type: ignore[override]
        # Kombu opens the final name and then writes. A worker that looks in between reads an empty
        # message and stops for good, so the message appears under its name only when it is whole.
        # Names sort by the time they were sent, also across restarts of the machine.
        name = f"{time_ns():020d}_{uuid.uuid4()}.{queue}.msg"
        folder = Path(self.data_folder_out)
        partial = folder / f"partial-{name}.writing"
        partial.write_text(dumps(payload), encoding="utf-8")
        partial.replace(folder / name)


class Transport(filesystem.Transport):
    Channel = Channel
    polling_interval = 0.2  # seconds; a press on a button should be felt
